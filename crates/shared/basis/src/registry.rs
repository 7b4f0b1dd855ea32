//! Lists of kinds that programs built on wakemix can extend: the kinds that come with it, and those that were
//! added.

use std::sync::RwLock;
use thiserror::Error;

/// Something with a name that is one of many of its kind.
pub trait Named {
    /// Its name, as it stands in a case file.
    fn name(&self) -> &'static str;
}

/// A list of descriptors: one kind of controller each, or of sensor. What reads case files, prints the
/// reference or puts a farm together looks kinds up here.
#[derive(Debug)]
pub struct Registry<K: ?Sized + 'static> {
    standard: &'static [&'static K],
    added: RwLock<Vec<&'static K>>,
}

/// A kind that cannot be added.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("a kind called `{name}` exists already; choose another name")]
pub struct NameTaken {
    /// The name.
    pub name: &'static str,
}

impl<K: Named + ?Sized> Registry<K> {
    /// The list of the kinds that come with the program.
    pub const fn new(standard: &'static [&'static K]) -> Self {
        Self { standard, added: RwLock::new(Vec::new()) }
    }

    /// Adds `kind` for the rest of the process, before cases that name it are read.
    ///
    /// # Errors
    /// [`NameTaken`] when there is a kind of its name.
    pub fn add(&self, kind: &'static K) -> Result<(), NameTaken> {
        let name = kind.name();
        // A thread that panicked while it held the list left it whole: a push is all that is ever done to it.
        let mut added = self.added.write().unwrap_or_else(std::sync::PoisonError::into_inner);
        if self.standard.iter().chain(added.iter()).any(|other| other.name() == name) {
            return Err(NameTaken { name });
        }
        added.push(kind);
        Ok(())
    }

    /// All kinds, those of the program first, then in the order in which they were added.
    pub fn all(&self) -> Vec<&'static K> {
        let added = self.added.read().unwrap_or_else(std::sync::PoisonError::into_inner);
        self.standard.iter().chain(added.iter()).copied().collect()
    }

    /// The kind called `name`.
    pub fn find(&self, name: &str) -> Option<&'static K> {
        self.all().into_iter().find(|kind| kind.name() == name)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    struct Colour(&'static str);

    impl Named for Colour {
        fn name(&self) -> &'static str {
            self.0
        }
    }

    static RED: Colour = Colour("red");
    static BLUE: Colour = Colour("blue");
    static COLOURS: Registry<Colour> = Registry::new(&[&RED]);

    #[test]
    fn a_kind_is_added_once_and_found_by_its_name() {
        assert!(COLOURS.find("blue").is_none());
        COLOURS.add(&BLUE).expect("there is none yet");
        assert_eq!(COLOURS.add(&BLUE), Err(NameTaken { name: "blue" }));
        assert_eq!(COLOURS.add(&Colour("red")), Err(NameTaken { name: "red" }));
        let names: Vec<&str> = COLOURS.all().iter().map(|colour| colour.name()).collect();
        assert_eq!(names, ["red", "blue"]);
        assert!(COLOURS.find("blue").is_some());
    }
}
