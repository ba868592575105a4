//! Numbers and counts in messages.

/// A number with a comma between thousands, as in `16,471`.
pub fn grouped(number: u128) -> String {
    let digits = number.to_string();
    let mut out = String::new();
    for (place, digit) in digits.chars().enumerate() {
        if place > 0 && (digits.len() - place).is_multiple_of(3) {
            out.push(',');
        }
        out.push(digit);
    }
    out
}

/// A number and its noun, as in `1 edge`, `2 edges`.
pub fn counted(number: usize, noun: &str) -> String {
    format!("{} {noun}{}", grouped(number as u128), if number == 1 { "" } else { "s" })
}

/// A number of vertices, as in `1 vertex`, `2 vertices`.
pub fn vertices(number: usize) -> String {
    format!("{} {}", grouped(number as u128), if number == 1 { "vertex" } else { "vertices" })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn thousands_are_grouped() {
        let texts = [0, 12, 123, 1234, 123_456, 1_234_567].map(grouped);
        assert_eq!(texts, ["0", "12", "123", "1,234", "123,456", "1,234,567"]);
    }

    #[test]
    fn one_is_singular() {
        assert_eq!([0, 1, 2].map(|count| counted(count, "edge")), ["0 edges", "1 edge", "2 edges"]);
        assert_eq!([1, 1000].map(vertices), ["1 vertex", "1,000 vertices"]);
    }
}
