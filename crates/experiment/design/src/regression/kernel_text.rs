//! Kernels as they are written: `matern52`, `se(wind,yaw)*periodic(direction:360)+rq`.

use surrogate::{Kernel, Part, Shape, Term};

/// A kernel in words: summands between `+`, factors between `*`, each a shape with the inputs that it looks
/// at.
#[derive(Clone, Debug, PartialEq)]
pub struct KernelText(String);

const SHAPES: [(&[&str], Shape); 4] = [
    (&["se", "squared-exponential", "rbf"], Shape::SquaredExponential),
    (&["matern32"], Shape::Matern32),
    (&["matern52"], Shape::Matern52),
    (&["rq", "rational-quadratic"], Shape::RationalQuadratic { exponent: 1.0 }),
];

impl KernelText {
    /// The kernel of `text`; which inputs there are is looked at later.
    ///
    /// # Errors
    /// What is wrong with it, in words.
    pub fn new(text: &str) -> Result<Self, String> {
        for part in text.split(['+', '*']) {
            shape(part.trim()).map(|_| ())?;
        }
        Ok(Self(text.to_owned()))
    }

    /// As it was written.
    pub fn text(&self) -> &str {
        &self.0
    }

    /// The kernel over the inputs of these `names`, its hyperparameters still to be found.
    ///
    /// # Errors
    /// An input that is not among them, in words.
    pub(super) fn kernel(&self, names: &[String]) -> Result<Kernel, String> {
        let of_term = |term: &str| {
            let parts = term.split('*').map(|text| part(text.trim(), names));
            Ok(Term { variance: 1.0, parts: parts.collect::<Result<_, String>>()? })
        };
        Ok(Kernel { terms: self.0.split('+').map(of_term).collect::<Result<_, String>>()? })
    }
}

/// The shape that `text` begins with, and what stands in its parentheses.
fn shape(text: &str) -> Result<(Shape, Vec<&str>), String> {
    let (name, inputs) = match text.split_once('(') {
        Some((name, rest)) => {
            let inside =
                rest.strip_suffix(')').ok_or_else(|| format!("\"{text}\" lacks its \")\""))?;
            (name.trim(), inside.split(',').map(str::trim).collect())
        }
        None => (text, Vec::new()),
    };
    if name == "periodic" {
        let asks =
            || "a periodic part names one input and its period, such as periodic(direction:360)";
        let [one] = inputs[..] else { return Err(asks().to_owned()) };
        let (input, period) = one.rsplit_once(':').ok_or_else(asks)?;
        let period: f64 = period.trim().parse().map_err(|_| asks().to_owned())?;
        if !(period > 0.0 && period.is_finite()) {
            return Err(format!("the period of {input} is {period}; give one above 0"));
        }
        return Ok((Shape::Periodic { period }, vec![input.trim()]));
    }
    let found = SHAPES.iter().find(|(names, _)| names.contains(&name));
    match found {
        Some((_, shape)) => Ok((*shape, inputs)),
        None => Err(format!(
            "\"{name}\" is no kernel; give se, matern32, matern52, rq or periodic(INPUT:PERIOD), with + and * between them"
        )),
    }
}

fn part(text: &str, names: &[String]) -> Result<Part, String> {
    let (shape, wanted) = shape(text)?;
    let index = |name: &str| {
        names.iter().position(|other| other == name).ok_or_else(|| {
            format!(
                "the kernel names \"{name}\", which is not among the inputs {}",
                names.join(", ")
            )
        })
    };
    let inputs: Vec<usize> = match wanted[..] {
        [] => (0..names.len()).collect(),
        _ => wanted.iter().map(|name| index(name)).collect::<Result<_, String>>()?,
    };
    Ok(Part { shape, lengths: vec![1.0; inputs.len()], inputs })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sums_and_products_are_read_and_what_is_none_is_named() {
        let names = ["wind".to_owned(), "direction".to_owned()];
        let text = KernelText::new("se(wind) * periodic(direction:360) + rq").expect("a kernel");
        let kernel = text.kernel(&names).expect("its inputs");
        assert_eq!(kernel.terms.len(), 2);
        let [first, second] = &kernel.terms[0].parts[..] else { panic!("two parts") };
        assert_eq!((&first.inputs[..], &second.inputs[..]), (&[0][..], &[1][..]));
        assert_eq!(second.shape, Shape::Periodic { period: 360.0 });
        assert_eq!(kernel.terms[1].parts[0].inputs, [0, 1]);
        assert!(KernelText::new("matern").expect_err("none").contains("matern52"));
        assert!(KernelText::new("periodic").expect_err("none").contains("period"));
        assert!(KernelText::new("se(wind").expect_err("none").contains(')'));
        let other = KernelText::new("se(yaw)").expect("a kernel").kernel(&names);
        assert!(other.expect_err("no such input").contains("yaw"));
    }
}
