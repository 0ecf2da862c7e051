//! The correct spelling nearest to what was found.

use std::fmt::Write;

/// The known spelling nearest to `found`, upper and lower case counting as equal; `None` if nothing is known.
pub(crate) fn nearest<'a>(
    found: &str,
    known: impl IntoIterator<Item = &'a str>,
) -> Option<&'a str> {
    let found = found.to_lowercase();
    let mut best: Option<(f64, &str)> = None;
    for candidate in known {
        let closeness = strsim::normalized_damerau_levenshtein(&found, &candidate.to_lowercase());
        if best.is_none_or(|(closest, _)| closeness > closest) {
            best = Some((closeness, candidate));
        }
    }
    best.map(|(_, candidate)| candidate)
}

/// Whether one spelling may well be meant by the other: two thirds of it agree.
pub(crate) fn alike(found: &str, known: &str) -> bool {
    strsim::normalized_damerau_levenshtein(&found.to_lowercase(), &known.to_lowercase()) > 0.66
}

/// End of an error message: the nearest spelling, and all of them where they are few.
pub(crate) fn hint<'a>(found: &str, known: impl IntoIterator<Item = &'a str>) -> String {
    const FEW: usize = 16;
    let mut known: Vec<&str> = known.into_iter().collect();
    known.dedup();
    let Some(nearest) = nearest(found, known.iter().copied()) else {
        return String::new();
    };
    let mut text = format!("; the nearest is {nearest:?}");
    if known.len() > 1 && known.len() <= FEW {
        let _ = write!(text, " (known: {})", known.join(", "));
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_swap_of_letters_finds_its_word() {
        assert_eq!(nearest("tetx", ["rho", "text", "k"]), Some("text"));
        assert_eq!(nearest("RHO", ["n", "rho"]), Some("rho"));
        assert_eq!(nearest("anything", []), None);
    }

    #[test]
    fn a_hint_lists_what_is_known_where_that_is_little() {
        assert_eq!(
            hint("roh", ["rho", "a"]),
            "; the nearest is \"rho\" (known: rho, a)"
        );
        assert_eq!(hint("roh", []), "");
    }
}
