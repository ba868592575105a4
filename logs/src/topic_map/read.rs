//! Reading a topic map: bytes in, a [`TopicMap`] or an error out.

use std::collections::BTreeMap;

use toposlam_model::format::document::{Document, DocumentError, DocumentValue};

use super::{
    AngleUnit, Carrier, LengthUnit, MarkerPlace, MessagePart, Role, ScannerFrames, TopicMap,
    invalid,
};

pub(super) fn read(bytes: &[u8]) -> Result<TopicMap, DocumentError> {
    let document = Document::parse_toml(bytes)?;
    let known: Vec<_> = Role::ALL.into_iter().map(Role::name).chain([SCANNER]).collect();
    let file = document.root().table(&known)?;
    let mut carriers = BTreeMap::new();
    let mut assumed = None;
    for role in Role::ALL {
        let Some(value) = file.get(role.name()) else { continue };
        match assumed_marker(value).filter(|_| role == Role::Marker) {
            Some(at) => assumed = Some(place(value, at)?),
            None => drop(carriers.insert(role, carrier(role, value)?)),
        }
    }
    let scanner = file.get(SCANNER).map(scanner).transpose()?.unwrap_or_default();
    if carriers.is_empty() && assumed.is_none() && scanner == ScannerFrames::default() {
        return Err(invalid(&file.position(), "no topic is mapped".to_owned()));
    }
    Ok(TopicMap { carriers, assumed, scanner })
}

/// The table of what no transform states of the scanner.
const SCANNER: &str = "scanner";

fn scanner(value: DocumentValue<'_>) -> Result<ScannerFrames, DocumentError> {
    const EXPECTED: &str = "a list of x, y and yaw: metres ahead and to the left, and radians";
    let table = value.table(&["mount", "base_frame"])?;
    let mount = |mount: DocumentValue<'_>| {
        let numbers = mount.list(EXPECTED)?;
        let numbers =
            numbers.map(|number| number.number_in("a length or an angle", -100.0..=100.0));
        let numbers = numbers.collect::<Result<Vec<_>, _>>()?;
        <[f64; 3]>::try_from(numbers).map_err(|_| mount.expected(EXPECTED))
    };
    let base = |frame| text(frame, "the name of a frame").map(str::to_owned);
    Ok(ScannerFrames {
        mount: table.get("mount").map(mount).transpose()?,
        base_frame: table.get("base_frame").map(base).transpose()?,
    })
}

fn assumed_marker(value: DocumentValue<'_>) -> Option<DocumentValue<'_>> {
    value.any_table().ok()?.get("at")
}

fn place<'d>(
    table: DocumentValue<'d>,
    at: DocumentValue<'d>,
) -> Result<MarkerPlace, DocumentError> {
    const EXPECTED: &str = "a list of x, y and heading, or of x and y";
    table.table(&["at"])?;
    let numbers = at.list(EXPECTED)?.map(|number| {
        // The robot's world is far smaller.
        number.number_in("a coordinate or a heading", -1e7..=1e7)
    });
    match numbers.collect::<Result<Vec<_>, _>>()?[..] {
        [x, y] => Ok(MarkerPlace { position: [x, y], heading: None }),
        [x, y, heading] => Ok(MarkerPlace { position: [x, y], heading: Some(heading) }),
        _ => Err(at.expected(EXPECTED)),
    }
}

fn carrier(role: Role, value: DocumentValue<'_>) -> Result<Carrier, DocumentError> {
    let parts = role.parts().iter().map(|part| part.name());
    let units: &[_] = match role {
        Role::Odometry | Role::Motion => &["length", "angle"],
        Role::Marker => &["id", "frame", "at"],
        _ => &[],
    };
    let known: Vec<_> = ["topic"].into_iter().chain(parts).chain(units.iter().copied()).collect();
    let table = value.table(&known)?;
    let topic = table.need("topic")?;
    let mut carrier = Carrier::usual(text(topic, "the name of a topic")?);
    carrier.place = topic.position();
    for &part in role.parts() {
        if let Some(path) = table.get(part.name()) {
            carrier.paths.insert(part, text(path, "the path of a field")?.to_owned());
            carrier.places.insert(part, path.position());
        }
    }
    if let Some(unit) = table.get("length") {
        carrier.length = unit.word(&LengthUnit::ALL.map(|it| (it.name(), it)))?;
    }
    if let Some(unit) = table.get("angle") {
        carrier.angle = unit.word(&AngleUnit::ALL.map(|it| (it.name(), it)))?;
    }
    if let Some(id) = table.get("id") {
        carrier.id = Some(match id.whole() {
            Ok(number) => number.to_string(),
            Err(_) => text(id, "the number or the name of a tag")?.to_owned(),
        });
    }
    if let Some(frame) = table.get("frame") {
        carrier.frame = Some(text(frame, "the name of a frame")?.to_owned());
    }
    match carrier.places.get(&MessagePart::Quaternion) {
        Some(place) if carrier.paths.contains_key(&MessagePart::Heading) => {
            let why = "there are both `heading` and `quaternion`; the file needs only one of them";
            Err(invalid(place, why.to_owned()))
        }
        _ => Ok(carrier),
    }
}

fn text<'d>(value: DocumentValue<'d>, expected: &'static str) -> Result<&'d str, DocumentError> {
    match value.text() {
        Ok(text) if !text.is_empty() => Ok(text),
        _ => Err(value.expected(expected)),
    }
}
