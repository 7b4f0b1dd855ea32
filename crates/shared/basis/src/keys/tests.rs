//! Defaults as values, and values that keys may hold.

use super::*;

const SPEEDS: Holds = Holds::Numbers(Range { low: 0.0, open: true, high: 40.0 });
static KEYS: [Key; 4] = [
    key("speeds", SPEEDS, "m/s", LeftOut::Value("[8, 9.5]"), ""),
    key("places", Holds::Turbines, "", LeftOut::Value("[]"), ""),
    key("length", above(0.0, 5.0), "m", LeftOut::Required, ""),
    key("word", Holds::Choice(&["a", "b"]), "", LeftOut::Value("\"b\""), ""),
];

#[test]
fn defaults_are_read_as_they_would_stand_in_the_file() {
    let values = Values::defaults(&KEYS);
    assert_eq!(values.numbers("speeds"), [8.0, 9.5]);
    assert_eq!(values.get("places"), Some(&Value::Names(Vec::new())));
    assert_eq!((values.has("length"), values.word("word")), (false, "b"));
    for key in &KEYS {
        assert!(values.get(key.name).is_none_or(|value| key.holds.accepts(value)), "{key:?}");
    }
}

#[test]
fn a_table_within_a_table_is_accepted_key_by_key() {
    static ROUGH: Table = Table { heading: "", about: "", keys: &KEYS };
    let with = |name, value: Value| Value::Table(Values(vec![(name, value)]));
    let holds = Holds::Ground(&ROUGH);
    assert!(holds.accepts(&"slip".into()) && holds.accepts(&with("length", 0.1.into())));
    for wrong in ["rough".into(), with("length", 6.0.into()), with("width", 0.1.into())] {
        assert!(!holds.accepts(&wrong), "{wrong:?}");
    }
}

#[test]
fn tables_under_one_heading_are_accepted_one_by_one() {
    static ROUGH: Table = Table { heading: "", about: "", keys: &KEYS };
    let one = |length: f64| Values(vec![("length", length.into())]);
    let holds = Holds::Tables(&ROUGH);
    assert!(holds.accepts(&Value::Tables(vec![one(0.1), one(5.0)])));
    assert!(!holds.accepts(&Value::Tables(vec![one(0.1), one(6.0)])));
    let mut values = Values::none();
    values.set("rough", Value::Tables(vec![one(0.1), one(5.0)]));
    assert_eq!(values.tables("rough")[1].number("length"), 5.0);
    assert!(values.tables("length").is_empty());
}
