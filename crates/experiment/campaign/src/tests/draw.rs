//! A part of a campaign's combinations, drawn by chance.

use super::{CAMPAIGN, written};
use crate::task::{self, Task};

#[test]
fn a_draw_has_whole_combinations_and_those_of_a_smaller_one() {
    let drawn = |draw: &str| {
        let text = CAMPAIGN.replace("[factors]", &format!("seeds = [1, 2]\n{draw}\n[factors]"));
        let folder = written(&text);
        let file = formats::shipped::read_campaign(&folder.path().join("campaign.toml")).unwrap();
        let task::Tasks { tasks, n_excluded, n_undrawn } = task::all(&file).unwrap();
        assert_eq!(n_excluded, 0);
        (tasks, n_undrawn)
    };
    let (all, undrawn) = drawn("");
    assert_eq!((all.len(), undrawn), (12, 0));
    assert_eq!(drawn("draw = 7"), (all.clone(), 0));
    let (four, undrawn) = drawn("draw = 4");
    assert_eq!((four.len(), undrawn), (8, 4));
    let (two, undrawn) = drawn("draw = 2");
    assert_eq!((two.len(), undrawn), (4, 8));
    for tasks in [&two, &four] {
        // Both seeds of each, next to each other, in the order of all.
        let is_pair = |pair: &[Task]| {
            let [first, second] = pair else { return false };
            first.columns[..2] == second.columns[..2] && first.columns[2] != second.columns[2]
        };
        assert!(tasks.chunks(2).all(is_pair), "{tasks:?}");
        let places = tasks.iter().map(|task| all.iter().position(|other| other == task));
        let places: Vec<Option<usize>> = places.collect();
        assert!(places.iter().all(Option::is_some) && places.is_sorted(), "{places:?}");
    }
    assert!(two.iter().all(|task| four.contains(task)));
}

/// Of two factors one is drawn: what is drawn has all levels of the other, and both seeds.
#[test]
fn what_is_not_drawn_is_whole() {
    let text = CAMPAIGN
        .replace("[factors]", "seeds = [1, 2]\ndraw = 1\ndraw_whole = [\"NAME\"]\n[factors]");
    let read = |name: &str| {
        let folder = written(&text.replace("NAME", name));
        formats::shipped::read_campaign(&folder.path().join("campaign.toml"))
    };
    let all = read("wind.speed").unwrap();
    assert_eq!(all.factors.len(), 3);
    for factor in &all.factors[..2] {
        let tasks = task::all(&read(&factor.name).unwrap()).unwrap().tasks;
        assert_eq!(tasks.len(), 2 * factor.levels.len(), "{tasks:?}");
        let values = |key: &str| {
            let own = |task: &Task| {
                task.columns.iter().find(|(name, _)| name == key).map(|(_, value)| value.words())
            };
            tasks.iter().filter_map(own).collect::<std::collections::BTreeSet<_>>().len()
        };
        for other in &all.factors[..2] {
            let key = &other.levels[0].settings[0].key;
            let expected = if other.name == factor.name { factor.levels.len() } else { 1 };
            assert_eq!(values(key), expected, "{key}");
        }
    }
    let error = read("wind.spede").unwrap_err().to_lines();
    assert!(error.contains("`draw_whole` names `wind.spede`, which is no factor"), "{error}");
}
