//! Tracks of particles: columns, units, gaps, and what is refused.

use super::*;
use std::fs;

fn read(name: &str, text: &str) -> Result<(Vec<Particle>, Seen), FileError> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    fs::write(&path, text).unwrap();
    let mut all = Vec::new();
    let seen = each_particle(&path, Lengths::Metres, |particle| all.push(*particle))?;
    Ok((all, seen))
}

#[test]
fn the_same_particles_come_from_csv_and_tecplot() {
    let csv = "time [s],x [mm],y [mm],z [mm],u [m/s],v [m/s],w [m/s],track\n0.5,100,200,300,5,0.1,-0.2,7\n0.6,nan,200,300,5,0.1,-0.2,7\n0.5,100,200,300,5,0.1,-0.2,8\n";
    let (from_csv, seen) = read("tracks.csv", csv).unwrap();
    let expected = Seen { n: 3, n_times_back: 1, span: Some([0.5, 0.6]), ..Seen::default() };
    assert_eq!(seen, expected);
    let expected =
        Particle { time: Some(0.5), position: [0.1, 0.2, 0.3], velocity: [5.0, 0.1, -0.2] };
    assert!((from_csv[0].position[2] - 0.3).abs() < 1e-15);
    assert_eq!(from_csv[0].velocity, expected.velocity);
    assert!(from_csv[1].position[0].is_nan());
    let tecplot = "TITLE = \"tracks\"\nVARIABLES = \"x [mm]\", \"y [mm]\"\n\"z [mm]\" \"Vx\" \"Vy\" \"Vz\" \"trackID\"\nZONE T=\"Snapshot 1\", SOLUTIONTIME=0.5\nI=2, F=POINT\n100 200 300 5 0.1 -0.2 7\n1.1e2 200 300 5 0.1 -0.2 8\nZONE T=\"2\", SOLUTIONTIME = 0.6\n120 200 300 5 0.1 -0.2 7\n";
    let (from_tecplot, seen) = read("tracks.dat", tecplot).unwrap();
    assert_eq!((seen.n, seen.n_times_back), (3, 0));
    assert_eq!(from_tecplot[0], from_csv[0]);
    assert_eq!(from_tecplot[2].time, Some(0.6));
}

#[test]
fn what_is_wrong_is_named_with_its_place() {
    let cases = [
        ("tracks.csv", "x,y,z,u,v\n1,2,3,4,5\n", "no column `w`"),
        ("tracks.csv", "x [mm],y [m],z [m],u,v,w\n1,2,3,4,5,6\n", "different units"),
        ("tracks.csv", "x [mm],y,z,u,v,w\n1,2,3,4,5,6\n", "different units"),
        ("tracks.csv", "x,y,z,u [m/s],v,w\n1,2,3,4,5,6\n", "`u` and `v` are in different units"),
        ("tracks.csv", "x [ft],y [ft],z [ft],u,v,w\n1,2,3,4,5,6\n", "`x` is in ft"),
        ("tracks.csv", "x,y,z,u,v,w\n1,2,3,4,5,6\n1,2,3\n", "line 3"),
        ("tracks.csv", "x,y,z,u,v,w\n1,2,3,4,5,six\n", "`six` in w"),
        ("tracks.dat", "VARIABLES = x y z u v w\nZONE\n1 2 3 4 5\n", "line 3: 5 values"),
        ("tracks.dat", "VARIABLES = x y z u v w\nZONE F=BLOCK\n1 2 3 4 5 6\n", "BLOCK"),
        ("tracks.dat", "1 2 3\n", "VARIABLES"),
        ("tracks.dat", "VARIABLES = x y z u v w\nZONE\nnone 2 3 4 5 6\n", "`none` is not a number"),
        ("tracks.dat", "VARIABLES = x y z u v w\nZONE\nbad 2 3 4 5 6\n", "`bad` is not a number"),
        (
            "tracks.dat",
            "VARIABLES = x y z u v w\nZONE SOLUTIONTIME=soon\n1 2 3 4 5 6\n",
            "SOLUTIONTIME = soon",
        ),
    ];
    for (name, text, expected) in cases {
        let message = read(name, text).unwrap_err().to_string();
        assert!(message.contains(expected) && message.contains(name), "{message}");
    }
}
