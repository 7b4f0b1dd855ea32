//! Colours: inks with a name, one colour per run, and the maps from values to colours.

/// A colour that knows what it is for, so that a dark page can choose another.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Ink {
    /// Titles and values.
    Text,
    /// Labels and explanations.
    Muted,
    /// Axes.
    Axis,
    /// Lines of a grid.
    Grid,
    /// Bands behind the lines.
    Band,
    /// The sheet.
    Paper,
    /// What must be seen on a coloured field, on every page.
    OnField,
    /// The halo around that.
    FieldHalo,
    /// The run of this index.
    Run(usize),
}

/// Colours for runs that differ for colour-blind readers too: slate for the compared run, then the
/// set of Okabe and Ito ("Color Universal Design", 2008) with the purple of Tol's bright scheme and
/// a yellow dark enough for lines; four more, further apart in lightness than in hue, for large
/// studies. The second column is for dark pages.
const RUNS: [([u8; 3], [u8; 3]); 11] = [
    ([95, 107, 122], [160, 173, 187]),
    ([213, 94, 0], [245, 138, 66]),
    ([0, 114, 178], [84, 172, 229]),
    ([0, 146, 108], [52, 199, 157]),
    ([170, 51, 119], [224, 133, 190]),
    ([196, 138, 0], [242, 190, 84]),
    ([66, 160, 214], [150, 211, 247]),
    ([110, 64, 28], [201, 158, 122]),
    ([136, 116, 205], [182, 168, 240]),
    ([104, 122, 14], [180, 198, 82]),
    ([14, 84, 92], [96, 176, 182]),
];

/// Dashes of the runs beyond the last colour, so that no two look alike.
const DASHES: [Option<[f64; 2]>; 3] = [None, Some([7.0, 3.0]), Some([2.0, 2.5])];

/// Number of different colours for runs.
pub(crate) const N_RUN_COLOURS: usize = RUNS.len();

/// Which colour the run of index `run` has; the first is kept for the run that others compare with.
pub(crate) fn run_colour(run: usize) -> usize {
    if run < RUNS.len() { run } else { 1 + (run - RUNS.len()) % (RUNS.len() - 1) }
}

/// The dash of the run of index `run`.
pub(crate) fn run_dash(run: usize) -> Option<[f64; 2]> {
    let cycle = if run < RUNS.len() { 0 } else { 1 + (run - RUNS.len()) / (RUNS.len() - 1) };
    DASHES[cycle % DASHES.len()]
}

impl Ink {
    /// The name under which the page's style sheet knows it.
    pub(crate) fn name(self) -> String {
        match self {
            Self::Text => "text".to_owned(),
            Self::Muted => "muted".to_owned(),
            Self::Axis => "axis".to_owned(),
            Self::Grid => "grid".to_owned(),
            Self::Band => "band".to_owned(),
            Self::Paper => "paper".to_owned(),
            Self::OnField => "on-field".to_owned(),
            Self::FieldHalo => "field-halo".to_owned(),
            Self::Run(run) => format!("run-{}", run_colour(run)),
        }
    }

    /// Its red, green and blue on a light or a dark sheet.
    pub(crate) fn rgb(self, dark: bool) -> [u8; 3] {
        let (light_rgb, dark_rgb) = match self {
            Self::Text => ([24, 33, 43], [232, 237, 242]),
            Self::Muted => ([91, 102, 115], [157, 169, 181]),
            Self::Axis => ([142, 152, 163], [104, 118, 132]),
            Self::Grid => ([231, 235, 239], [44, 54, 64]),
            Self::Band => ([244, 246, 248], [32, 40, 49]),
            Self::Paper => ([255, 255, 255], [23, 30, 38]),
            Self::OnField => ([17, 22, 28], [17, 22, 28]),
            Self::FieldHalo => ([255, 255, 255], [255, 255, 255]),
            Self::Run(run) => RUNS[run_colour(run)],
        };
        if dark { dark_rgb } else { light_rgb }
    }

    /// Every ink, each colour of the runs once.
    pub(crate) fn all() -> impl Iterator<Item = Self> {
        [
            Self::Text,
            Self::Muted,
            Self::Axis,
            Self::Grid,
            Self::Band,
            Self::Paper,
            Self::OnField,
            Self::FieldHalo,
        ]
        .into_iter()
        .chain((0..N_RUN_COLOURS).map(Self::Run))
    }
}

/// `#rrggbb`.
pub(crate) fn hex([red, green, blue]: [u8; 3]) -> String {
    format!("#{red:02x}{green:02x}{blue:02x}")
}

/// Which colours a field is shown in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Map {
    /// Small to large: deep blue (the wake) over teal to pale sand (the free stream).
    Sequential,
    /// Below to above zero: blue, white, brick.
    Diverging,
}

/// The 256 colours of `map`, from the lowest to the highest value.
///
/// Anchors are joined in the OKLab space (Ottosson, "A perceptual color space for image
/// processing", 2020) and the way through them is walked in equal steps of that space, so that
/// equal differences of the value look equally large.
pub(crate) fn palette(map: Map) -> Vec<[u8; 3]> {
    // Lightness, chroma, hue (deg).
    let anchors: &[[f64; 3]] = match map {
        Map::Sequential => &[
            [0.21, 0.075, 285.0],
            [0.35, 0.105, 268.0],
            [0.49, 0.105, 243.0],
            [0.62, 0.095, 212.0],
            [0.75, 0.090, 178.0],
            [0.87, 0.080, 128.0],
            [0.965, 0.050, 102.0],
        ],
        Map::Diverging => &[
            [0.36, 0.120, 262.0],
            [0.55, 0.115, 250.0],
            [0.76, 0.070, 240.0],
            [0.965, 0.004, 240.0],
            [0.965, 0.004, 60.0],
            [0.78, 0.085, 55.0],
            [0.58, 0.135, 42.0],
            [0.39, 0.125, 32.0],
        ],
    };
    let corners: Vec<[f64; 3]> = anchors
        .iter()
        .map(|&[lightness, chroma, hue]| {
            let (sine, cosine) = hue.to_radians().sin_cos();
            [lightness, chroma * cosine, chroma * sine]
        })
        .collect();
    let way = smooth_way(&corners);
    let mut lengths = vec![0.0];
    for pair in way.windows(2) {
        let step: f64 = (0..3).map(|axis| (pair[1][axis] - pair[0][axis]).powi(2)).sum();
        lengths.push(lengths[lengths.len() - 1] + step.sqrt());
    }
    let total = lengths[lengths.len() - 1];
    (0..256)
        .map(|index| {
            let wanted = total * f64::from(index) / 255.0;
            let after = lengths.partition_point(|&length| length < wanted).clamp(1, way.len() - 1);
            let span = (lengths[after] - lengths[after - 1]).max(f64::MIN_POSITIVE);
            let share = (wanted - lengths[after - 1]) / span;
            let (from, to) = (way[after - 1], way[after]);
            rgb_of_oklab([0, 1, 2].map(|axis| from[axis] + share * (to[axis] - from[axis])))
        })
        .collect()
}

/// Many points on a Catmull-Rom curve through `corners`.
fn smooth_way(corners: &[[f64; 3]]) -> Vec<[f64; 3]> {
    const N_STEPS: usize = 64;
    let last = corners.len() - 1;
    let mut way = vec![corners[0]];
    for index in 0..last {
        let before = corners[index.saturating_sub(1)];
        let (from, to) = (corners[index], corners[index + 1]);
        let after = corners[(index + 2).min(last)];
        for step in 1..=N_STEPS {
            let t = step as f64 / N_STEPS as f64;
            way.push([0, 1, 2].map(|axis| {
                let slope_from = 0.5 * (to[axis] - before[axis]);
                let slope_to = 0.5 * (after[axis] - from[axis]);
                let (t2, t3) = (t * t, t * t * t);
                (2.0 * t3 - 3.0 * t2 + 1.0) * from[axis]
                    + (t3 - 2.0 * t2 + t) * slope_from
                    + (3.0 * t2 - 2.0 * t3) * to[axis]
                    + (t3 - t2) * slope_to
            }));
        }
    }
    way
}

/// sRGB of a colour in OKLab (lightness, a, b), clipped to what a screen can show.
///
/// Matrices from Ottosson's article.
fn rgb_of_oklab([lightness, a, b]: [f64; 3]) -> [u8; 3] {
    let long = (lightness + 0.396_337_777_4 * a + 0.215_803_757_3 * b).powi(3);
    let medium = (lightness - 0.105_561_345_8 * a - 0.063_854_172_8 * b).powi(3);
    let short = (lightness - 0.089_484_177_5 * a - 1.291_485_548_0 * b).powi(3);
    [
        4.076_741_662_1 * long - 3.307_711_591_3 * medium + 0.230_969_929_2 * short,
        -1.268_438_004_6 * long + 2.609_757_401_1 * medium - 0.341_319_396_5 * short,
        -0.004_196_086_3 * long - 0.703_418_614_7 * medium + 1.707_614_701_0 * short,
    ]
    .map(|linear| {
        let linear = linear.clamp(0.0, 1.0);
        let encoded = if linear <= 0.003_130_8 {
            12.92 * linear
        } else {
            1.055 * linear.powf(1.0 / 2.4) - 0.055
        };
        (255.0 * encoded).round() as u8
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Lightness of an sRGB colour in OKLab.
    fn lightness(rgb: [u8; 3]) -> f64 {
        let [red, green, blue] = rgb.map(|channel| {
            let encoded = f64::from(channel) / 255.0;
            if encoded <= 0.040_45 {
                encoded / 12.92
            } else {
                ((encoded + 0.055) / 1.055).powf(2.4)
            }
        });
        let long = 0.412_221_470_8 * red + 0.536_332_536_3 * green + 0.051_445_992_9 * blue;
        let medium = 0.211_903_498_2 * red + 0.680_699_545_1 * green + 0.107_396_956_6 * blue;
        let short = 0.088_302_461_9 * red + 0.281_718_837_6 * green + 0.629_978_700_5 * blue;
        0.210_454_255_3 * long.cbrt() + 0.793_617_785_0 * medium.cbrt()
            - 0.004_072_046_8 * short.cbrt()
    }

    #[test]
    fn the_sequential_map_grows_evenly_lighter() {
        let colours = palette(Map::Sequential);
        assert_eq!(colours.len(), 256);
        let steps: Vec<f64> = (0..8)
            .map(|part| {
                lightness(colours[(part + 1) * 255 / 8]) - lightness(colours[part * 255 / 8])
            })
            .collect();
        let mean = steps.iter().sum::<f64>() / 8.0;
        assert!(steps.iter().all(|step| (step / mean - 1.0).abs() < 0.35), "{steps:?}");
        assert!(lightness(colours[0]) < 0.25 && lightness(colours[255]) > 0.93);
    }

    #[test]
    fn the_diverging_map_is_palest_in_the_middle_and_even_on_both_sides() {
        let colours = palette(Map::Diverging);
        let palest =
            (0..256).max_by(|&a, &b| lightness(colours[a]).total_cmp(&lightness(colours[b])));
        assert!(palest.is_some_and(|index| index.abs_diff(128) < 8), "{palest:?}");
        assert!((lightness(colours[32]) - lightness(colours[223])).abs() < 0.08);
    }

    #[test]
    fn runs_differ_in_colour_or_dash() {
        let looks: Vec<_> =
            (0..30).map(|run| (run_colour(run), run_dash(run).map(|d| d[0] as i64))).collect();
        for (index, look) in looks.iter().enumerate() {
            assert!(!looks[..index].contains(look), "run {index} looks like an earlier one");
        }
    }
}
