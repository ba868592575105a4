use std::collections::BTreeMap;

use proptest::{collection::btree_map, prelude::*, sample::select};

use super::*;

const SMALL: &str = "\
version = 1
[stripe]
kind = \"floor\"
width = 0.05
[floor]
colour = [104, 106.5, 110]
[priors]
floor = 0.25
stripe = 0.25
marker = 0.25
other = 0.25
[smoothing]
colour = 0.7
light = 0.08
unknown_below = 1e-6
[histograms]
floor = [[13, 0, 0, 100]]
stripe = [[28, 1, 5, 7], [28, 0, 0, 9]]
marker = []
other = []
";

fn refusal(text: &str) -> String {
    let message = ColourModel::read(text.as_bytes()).unwrap_err().to_string();
    assert!(!message.contains('\n'), "{message}");
    message
}

#[test]
fn a_small_file_is_read() {
    let model = ColourModel::read(SMALL.as_bytes()).unwrap();
    assert!(model.to_toml().lines().all(|line| line.len() <= 100));
    assert_eq!(model.stripe, Stripe { kind: StripeKind::OnFloor, width: 0.05 });
    assert!(model.floor.into_iter().eq([104.0, 106.5, 110.0]));
    assert_eq!(model.priors, [0.25; 4]);
    assert_eq!(model.smoothing, Smoothing { colour: 0.7, light: 0.08 });
    assert!((model.unknown_below - 1e-6).abs() < 1e-12);
    let [floor, stripe, marker, other] = model.histograms;
    assert_eq!(floor, [(Bin { value: 13, chroma: 0, hue: 0 }, 100)]);
    assert_eq!(
        stripe,
        [(Bin { value: 28, chroma: 0, hue: 0 }, 9), (Bin { value: 28, chroma: 1, hue: 5 }, 7)]
    );
    assert_eq!([marker, other], [const { Vec::new() }; 2]);
}

/// The rows of a table with three columns: what is replaced, by what, and how the error begins.
fn rows(table: &str) -> impl Iterator<Item = [String; 3]> {
    table.lines().skip(1).map(|row| {
        let cells: Vec<_> = row.split(" | ").map(|cell| cell.replace(r"\n", "\n")).collect();
        cells.try_into().unwrap()
    })
}

const ERRORS: &str = r#"
version = 1\n |  | the key `version` is missing
version = 1 | version = 2 | line 1, column 11: version: this is version 2 of colour files; only version 1 can be read
version = 1 | version = 1.0 | line 1, column 11: version: expected a whole number, found a decimal number
version = 1 | version = | line 1, column 10:
version = 1 | version = 1\nname = 1 | line 2, column 1: name: unknown key; expected one of: version, stripe,
[floor]\ncolour | [flor]\ncolour | line 5, column 2: flor: unknown key; expected one of: version, stripe, floor
width = 0.05\n |  | line 2, column 2: stripe: the key `width` is missing
width = 0.05 | width = 5 | line 4, column 9: stripe.width: 5 is out of range; the width in metres lies between 0.005 and 0.5
width = 0.05 | width = nan | line 4, column 9: stripe.width: NaN is out of range
width = 0.05 | width = true | line 4, column 9: stripe.width: expected a number, found true or false
"floor" | "roof" | line 3, column 8: stripe.kind: expected "floor" or "wall", found another text
"floor" | 7 | line 3, column 8: stripe.kind: expected "floor" or "wall", found a whole number
104 | 0 | line 6, column 11: floor.colour[0]: 0 is out of range; a channel lies between 1 and 255
104, |  | line 6, column 10: floor.colour: expected a list of three numbers, red, green and blue, found
stripe = 0.25 | stripe = 0 | line 9, column 10: priors.stripe: 0 is out of range; a prior lies between 0.000001 and 1
stripe = 0.25 | stripes = 1 | line 9, column 1: priors.stripes: unknown key; expected one of: floor, stripe,
0.7 | inf | line 13, column 10: smoothing.colour: inf is out of range; the difference of colour lies between 0.1 and 4
1e-6 | 1 | line 15, column 17: smoothing.unknown_below: 1 is out of range; the share lies between 0 and 0.1
[13, 0, 0, 100] |  | line 17, column 9: histograms.floor: there is no colour; floor and stripe must have
[13, 0, | [32, 0, | line 17, column 11: histograms.floor[0][0]: 32 is out of range; the value lies between 0 and 31
[13, 0, | [13, 28, | line 17, column 15: histograms.floor[0][1]: 28 is out of range; the chroma lies between 0 and 27
[28, 1, 5, | [28, 1, 6, | line 18, column 19: histograms.stripe[0][2]: 6 is out of range; the hue lies between 0 and 5
0, 0, 9] | 0, 1, 9] | line 18, column 34: histograms.stripe[1][2]: 1 is out of range; the hue lies between 0 and 0
100] | 0] | line 17, column 21: histograms.floor[0][3]: 0 is out of range; the number of pixels lies between 1 and 1000000000000
100] | -1] | line 17, column 21: histograms.floor[0][3]: -1 is out of range; the
100] | 1.5] | line 17, column 21: histograms.floor[0][3]: expected a whole number, found a decimal number
, 100] | ] | line 17, column 10: histograms.floor[0]: expected a list of four whole numbers, value,
[13, 0, 0, 100] | "x" | line 17, column 10: histograms.floor[0]: expected a list of four whole
marker = [] | marker = {} | line 19, column 1: histograms.marker: expected a list of bins, found a table
28, 1, 5 | 28, 0, 0 | line 18, column 26: histograms.stripe[1]: there are two rows with value 28, chroma 0, hue 0
marker = []\n |  | line 16, column 2: histograms: the key `marker` is missing"#;

#[test]
fn an_error_has_its_place_and_range() {
    for [right, wrong, message] in rows(ERRORS) {
        assert!(SMALL.contains(&right), "{right}");
        let refusal = refusal(&SMALL.replacen(&right, &wrong, 1));
        assert!(refusal.starts_with(&message), "{refusal}\n{message}");
    }
    assert_eq!(refusal(""), "the file is empty");
    let not_text = ColourModel::read(b"version = 1\n# \xff").unwrap_err().to_string();
    assert_eq!(not_text, "line 2, column 3: this is not UTF-8 text");
}

fn histogram(least: usize) -> impl Strategy<Value = Histogram> {
    let bin = (0..32_u8, 0..64_u8, 0..378_u16).prop_map(|(value, chroma, hue)| {
        let chroma = chroma.min(Bin::most_chroma(value));
        Bin { value, chroma, hue: hue % Bin::hues(chroma) }
    });
    btree_map(bin, 1..=MOST_PIXELS as u64, least..20)
        .prop_map(|bins: BTreeMap<Bin, u64>| bins.into_iter().collect())
}

prop_compose! {
    fn models()(
        kind in select(vec![StripeKind::OnFloor, StripeKind::OnWall]),
        width in 0.005..=0.5_f64,
        floor in prop::array::uniform3(1.0..=255.0_f64),
        priors in prop::array::uniform4(1e-6..=1.0_f64),
        smoothing in (0.1..=4.0_f64, 0.0..=0.5_f64),
        unknown_below in 0.0..=0.1_f64,
        histograms in (histogram(1), histogram(1), histogram(0), histogram(0)),
    ) -> ColourModel {
        ColourModel {
            stripe: Stripe { kind, width },
            floor,
            priors,
            smoothing: Smoothing { colour: smoothing.0, light: smoothing.1 },
            unknown_below,
            histograms: histograms.into(),
        }
    }
}

proptest! {
    #[test]
    fn any_model_reads_as_it_was_written(model in models()) {
        let text = model.to_toml();
        let again = ColourModel::read(text.as_bytes());
        prop_assert_eq!(again.as_ref(), Ok(&model));
        prop_assert_eq!(again.map(|again| again.to_toml()), Ok(text));
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 12, ..Default::default() })]

    #[test]
    fn any_model_has_a_table(model in models()) {
        let table = model.table();
        prop_assert!(table.classes.iter().all(|&class| class != PixelClass::Unseen));
    }
}
