//! What a library said on the way, each thing once.

/// Most things that are kept; a library that says more says no more than these (–).
const MOST: usize = 8;

/// What was said.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Remarks(Vec<Remark>);

#[derive(Clone, Debug, PartialEq)]
struct Remark {
    about: String,
    /// Time at which it was said first (s).
    first: f32,
    n_times: u64,
}

impl Remarks {
    /// Takes down that the library said what `about` tells at `time` (s).
    pub(super) fn add(&mut self, time: f32, about: &str) {
        if let Some(known) = self.0.iter_mut().find(|remark| remark.about == about) {
            known.n_times += 1;
        } else if self.0.len() < MOST {
            self.0.push(Remark { about: about.to_owned(), first: time, n_times: 1 });
        }
    }

    /// Each as what follows "run R: T".
    pub(super) fn told(&self) -> Vec<String> {
        let told = |Remark { about, first, n_times }: &Remark| {
            let often = if *n_times > 1 { format!(", {n_times} times") } else { String::new() };
            format!("'s controller library {about}, at {first:.2} s{often}")
        };
        self.0.iter().map(told).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_same_is_told_once() {
        let mut remarks = Remarks::default();
        for step in 0..30 {
            remarks.add(0.1 * step as f32, "warned of a");
            remarks.add(0.1 * step as f32, &format!("warned of {}", step.min(1)));
        }
        assert_eq!(
            remarks.told(),
            [
                "'s controller library warned of a, at 0.00 s, 30 times",
                "'s controller library warned of 0, at 0.00 s",
                "'s controller library warned of 1, at 0.10 s, 29 times",
            ]
        );
    }
}
