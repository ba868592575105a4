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
    assert_eq!(model.stripe, Stripe { kind: StripeKind::OnFloor, width: 0.05 });
    assert!(model.floor.into_iter().eq([104.0, 106.5, 110.0]));
    assert_eq!(model.priors, Priors::EQUAL);
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

#[test]
fn what_is_wrong_is_named_with_its_place_and_range() {
    let cases = [
        ("version = 1\n", "", "the key `version` is missing"),
        ("version = 1", "version = 2", "this is version 2 of colour files; only version 1 is read"),
        ("version = 1", "version = 1.0", "version: expected a whole number, found a number"),
        ("version = 1", "version =", "line 1, column 10: "),
        (
            "version = 1",
            "version = 1\nname = 1",
            "name: unknown key; expected one of: version, stripe,",
        ),
        (
            "[floor]\ncolour",
            "[flor]\ncolour",
            "flor: unknown key; expected one of: version, stripe, floor",
        ),
        ("width = 0.05\n", "", "stripe: the key `width` is missing"),
        (
            "width = 0.05",
            "width = 5",
            "stripe.width: the width in metres is 5; it can be from 0.005 to 0.5",
        ),
        ("width = 0.05", "width = nan", "stripe.width: the width in metres is NaN; it can be"),
        ("width = 0.05", "width = true", "stripe.width: expected a number, found true or false"),
        (
            "\"floor\"",
            "\"roof\"",
            "stripe.kind: there is no stripe on the `roof`; there are floor and",
        ),
        ("\"floor\"", "7", "stripe.kind: expected a text, found a whole number"),
        ("104", "0", "floor.colour: a channel is 0; it can be from 1 to 255"),
        ("104,", "", "floor.colour: expected a list of three numbers, red, green and blue, not"),
        (
            "stripe = 0.25",
            "stripe = 0",
            "priors.stripe: a prior is 0; it can be from 0.000001 to 1",
        ),
        (
            "stripe = 0.25",
            "stripes = 1",
            "priors.stripes: unknown key; expected one of: floor, stripe,",
        ),
        (
            "0.7",
            "inf",
            "smoothing.colour: the difference of colour is inf; it can be from 0.1 to 4",
        ),
        ("1e-6", "1", "smoothing.unknown_below: the share is 1; it can be from 0 to 0.1"),
        ("[13, 0, 0, 100]", "", "histograms.floor: there is no colour; floor and stripe must have"),
        ("[13, 0,", "[32, 0,", "histograms.floor[0]: the value is 32; it can be from 0 to 31"),
        ("[13, 0,", "[13, 28,", "histograms.floor[0]: the chroma is 28; it can be from 0 to 27"),
        ("[28, 1, 5,", "[28, 1, 6,", "histograms.stripe[0]: the hue is 6; it can be from 0 to 5"),
        ("0, 0, 9]", "0, 1, 9]", "histograms.stripe[1]: the hue is 1; it can be from 0 to 0"),
        (
            "100]",
            "0]",
            "histograms.floor[0]: the number of pixels is 0; it can be from 1 to 1000000000000",
        ),
        ("100]", "-1]", "histograms.floor[0]: the number of pixels is -1; it can be"),
        ("100]", "1.5]", "histograms.floor[0]: expected a list of four whole numbers, value,"),
        (", 100]", "]", "histograms.floor[0]: expected a list of four whole numbers, value, "),
        ("[13, 0, 0, 100]", "\"x\"", "histograms.floor[0]: expected a list of four whole"),
        ("marker = []", "marker = {}", "histograms.marker: expected a list of bins, found a table"),
        ("28, 1, 5", "28, 0, 0", "histograms.stripe: value 28, chroma 0, hue 0 has stood before"),
        ("marker = []\n", "", "histograms: the key `marker` is missing"),
    ];
    for (right, wrong, message) in cases {
        assert!(SMALL.contains(right), "{right}");
        let refusal = refusal(&SMALL.replacen(right, wrong, 1));
        assert!(refusal.starts_with(message), "{refusal}\n{message}");
    }
    assert_eq!(refusal(""), "the key `version` is missing");
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
        let [floor_prior, stripe, marker, other] = priors;
        ColourModel {
            stripe: Stripe { kind, width },
            floor,
            priors: Priors { floor: floor_prior, stripe, marker, other },
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

    #[test]
    fn no_bytes_make_reading_panic(bytes: Vec<u8>) {
        if let Err(error) = ColourModel::read(&bytes) {
            prop_assert!(!error.to_string().contains('\n'));
        }
    }

    #[test]
    fn a_changed_file_is_read_or_refused(
        at in 0..SMALL.len(), remove in 0..4_usize, insert in "[-0-9a-z\\[\\]{}=.,\"'#\n ]{0,4}",
    ) {
        let end = (at + remove).min(SMALL.len());
        let text = [&SMALL[..at], &insert, &SMALL[end..]].concat();
        match ColourModel::read(text.as_bytes()) {
            Ok(model) => {
                let again = ColourModel::read(model.to_toml().as_bytes());
                prop_assert_eq!(again, Ok(model));
            }
            Err(error) => prop_assert!(!error.to_string().contains('\n')),
        }
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
