//! Tasks of processes that end, fail, or are there still.

use super::{CAMPAIGN, begun, column, made};
use crate::claim::{Claimed, Next};
use crate::table::{Table, patiently};
use crate::{RunOptions, make, status, worker};
use std::fs;

/// The next task for `worker` of this machine, which there is.
fn claimed(table: &mut Table, worker: &str, wanted: Option<(i64, i64)>) -> Claimed {
    match table.claim(worker, &worker::here(), wanted, |_| 0).unwrap() {
        Next::Task(claimed) => *claimed,
        other => panic!("{other:?}"),
    }
}

#[test]
fn what_a_killed_process_had_comes_back_and_goes_on() {
    let (_folder, out) = begun(CAMPAIGN);
    let claim = |name: &str| {
        let mut table = Table::open(&out).unwrap();
        claimed(&mut table, name, None).id
    };
    assert_eq!(claim("ended"), 1);
    let stands = status(&out).unwrap();
    assert_eq!((stands.counts.running, stands.n_left_behind, stands.time_left), (1, 1, None));
    let ended = made(&out, &RunOptions::default());
    assert_eq!((ended.n_done, ended.counts.done), (6, 6));
}

#[test]
fn a_task_that_ends_its_processes_is_failed_at_last() {
    let (_folder, out) = begun(CAMPAIGN);
    for _ in 0..3 {
        let mut table = Table::open(&out).unwrap();
        claimed(&mut table, "ended", Some((2, 2)));
        worker::bring_back(&out, &mut table).unwrap();
    }
    let stands = status(&out).unwrap();
    assert_eq!((stands.counts.failed, stands.failures[0].task), (1, 2));
    assert!(stands.failures[0].message.contains("3 processes ended"), "{:?}", stands.failures);
    assert_eq!(made(&out, &RunOptions::default()).counts.failed, 1);
    let retried = made(&out, &RunOptions { retry_failed: true, ..RunOptions::default() });
    assert_eq!((retried.n_done, retried.counts.done), (1, 6));
}

#[test]
fn a_task_of_a_process_that_is_there_stays_with_it() {
    let (_folder, out) = begun(CAMPAIGN);
    let worker = worker::Worker::enter(&out).unwrap();
    let mut table = Table::open(&out).unwrap();
    let id = claimed(&mut table, &worker.name, None).id;
    let ended = made(&out, &RunOptions::default());
    let found = (ended.n_done, ended.n_elsewhere, ended.counts.running);
    assert_eq!(found, (5, 1, 1), "{ended:?} {:?}", status(&out).unwrap().failures);
    // Nor does anybody else finish it.
    assert!(!table.finish(id, "somebody else", &[], 1.0, "").unwrap());
    drop(worker);
    assert_eq!(made(&out, &RunOptions::default()).n_done, 1);
}

#[test]
fn what_came_back_is_made_alone_and_fails_alone() {
    let (_folder, out) = begun(CAMPAIGN);
    let mut table = Table::open(&out).unwrap();
    let next = |table: &mut Table, name: &str| table.claim(name, "", Some((1, 3)), |_| 0).unwrap();
    // Two workers of a process: task 1 crashes it, task 2 is innocent.
    claimed(&mut table, "first", None);
    claimed(&mut table, "first", None);
    table.bring_back("first", |_| 0).unwrap();
    // The new one goes first; while it is held, none that came back is taken.
    assert_eq!(claimed(&mut table, "second", Some((1, 3))).id, 3);
    assert!(matches!(next(&mut table, "second"), Next::Wait));
    table.finish(3, "second", &[], 1.0, "").unwrap();
    assert_eq!(claimed(&mut table, "second", Some((1, 3))).id, 1);
    // Nothing is taken beside it, not even a new one.
    assert!(matches!(table.claim("second", "", None, |_| 0).unwrap(), Next::Wait));
    table.bring_back("second", |_| 0).unwrap();
    assert_eq!(claimed(&mut table, "third", Some((1, 3))).id, 1);
    table.bring_back("third", |_| 0).unwrap();
    assert_eq!(table.counts().unwrap().failed, 1);
    assert_eq!(claimed(&mut table, "fourth", Some((1, 3))).id, 2);
    assert!(table.finish(2, "fourth", &[], 1.0, "").unwrap());
    assert!(matches!(next(&mut table, "fourth"), Next::Nothing));
}

#[test]
fn a_task_that_got_further_is_not_blamed() {
    let (_folder, out) = begun(CAMPAIGN);
    let mut table = Table::open(&out).unwrap();
    for written in 1..9 {
        let mark = |at: i64| move |_| at;
        let next = table.claim("killed", "", Some((1, 1)), mark(written - 1)).unwrap();
        assert!(matches!(next, Next::Task(_)));
        table.bring_back("killed", mark(written)).unwrap();
    }
    assert_eq!(table.counts().unwrap().pending, 6);
    // Its folder tells: no checkpoint, one, a newer one.
    assert_eq!(make::mark(&out, 1), 0);
    let run = out.join("tasks/000001/helix");
    fs::create_dir_all(&run).unwrap();
    fs::write(run.join("checkpoint"), "").unwrap();
    let file = fs::File::open(run.join("checkpoint")).unwrap();
    let at = |nanoseconds| std::time::UNIX_EPOCH + std::time::Duration::from_nanos(nanoseconds);
    file.set_modified(at(5_000)).unwrap();
    assert_eq!(make::mark(&out, 1), 5_000);
    file.set_modified(at(7_000)).unwrap();
    assert_eq!(make::mark(&out, 1), 7_000);
}

#[test]
fn the_folder_of_a_retried_task_goes_when_somebody_has_it() {
    let (_folder, out) = begun(&CAMPAIGN.replace("runs", "keep = \"all\"\nruns"));
    let mut table = Table::open(&out).unwrap();
    claimed(&mut table, "one", Some((1, 1)));
    table.fail(1, "one", "for a test").unwrap();
    let left = out.join("tasks/000001/left");
    fs::create_dir_all(left.parent().unwrap()).unwrap();
    fs::write(&left, "").unwrap();
    // Another process retries it, and is making it while this one retries what failed.
    table.retry((1, 6)).unwrap();
    let live = worker::Worker::enter(&out).unwrap();
    assert!(claimed(&mut table, &live.name, Some((1, 1))).is_fresh);
    table.begin_anew(1, &live.name).unwrap();
    let retry = RunOptions { retry_failed: true, only: Some((1, 1)), ..RunOptions::default() };
    assert_eq!(made(&out, &retry).n_elsewhere, 1);
    assert!(left.exists());
    // Once it has begun, an interruption does not empty it again; a failure and another retry do.
    table.give_back(1, &live.name).unwrap();
    assert!(!claimed(&mut table, &live.name, Some((1, 1))).is_fresh);
    table.fail(1, &live.name, "for a test").unwrap();
    assert_eq!(made(&out, &retry).n_done, 1);
    assert!(!left.exists());
}

#[test]
fn a_damaged_checkpoint_is_begun_anew() {
    let (_folder, out) = begun(&CAMPAIGN.replace("runs", "keep = \"all\"\nruns"));
    let one = RunOptions { only: Some((1, 1)), ..RunOptions::default() };
    assert_eq!(made(&out, &one).n_done, 1);
    let before = column(&out, "T1.power.mean");
    let table = Table::open(&out).unwrap();
    table.connection.execute("UPDATE tasks SET state = 'pending', attempts = 0", []).unwrap();
    let run = out.join("tasks/000001/helix");
    fs::remove_file(run.join("summary.json")).unwrap();
    fs::write(run.join("checkpoint"), "no checkpoint").unwrap();
    let ended = made(&out, &one);
    assert_eq!((ended.n_done, ended.n_failed), (1, 0), "{:?}", status(&out).unwrap().failures);
    assert_eq!(column(&out, "T1.power.mean"), before);
    let backend = "SELECT backend FROM tasks WHERE id = 1";
    let backend: String = table.connection.query_row(backend, [], |row| row.get(0)).unwrap();
    assert!(!backend.is_empty());
}

#[test]
fn a_table_that_others_hold_is_tried_again_and_another_error_is_not() {
    let failure = |code| rusqlite::Error::SqliteFailure(rusqlite::ffi::Error::new(code), None);
    for (code, n_failures, n_tries, is_done) in [
        (rusqlite::ffi::SQLITE_BUSY, 3, 4, true),
        (rusqlite::ffi::SQLITE_BUSY, 99, 5, false),
        (rusqlite::ffi::SQLITE_FULL, 3, 1, false),
    ] {
        let mut tries = 0;
        let done = patiently(|| {
            tries += 1;
            if tries > n_failures { Ok(()) } else { Err(failure(code)) }
        });
        assert_eq!((tries, done.is_ok()), (n_tries, is_done), "{code}");
    }
}
