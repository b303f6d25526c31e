//! How the name of a parameter is written beside a slider.

const GREEK: [(&str, &str); 34] = [
    ("alpha", "α"),
    ("beta", "β"),
    ("gamma", "γ"),
    ("delta", "δ"),
    ("epsilon", "ε"),
    ("zeta", "ζ"),
    ("eta", "η"),
    ("theta", "θ"),
    ("iota", "ι"),
    ("kappa", "κ"),
    ("lambda", "λ"),
    ("mu", "μ"),
    ("nu", "ν"),
    ("xi", "ξ"),
    ("omicron", "ο"),
    ("pi", "π"),
    ("rho", "ρ"),
    ("sigma", "σ"),
    ("tau", "τ"),
    ("upsilon", "υ"),
    ("phi", "φ"),
    ("chi", "χ"),
    ("psi", "ψ"),
    ("omega", "ω"),
    ("Gamma", "Γ"),
    ("Delta", "Δ"),
    ("Theta", "Θ"),
    ("Lambda", "Λ"),
    ("Xi", "Ξ"),
    ("Pi", "Π"),
    ("Sigma", "Σ"),
    ("Phi", "Φ"),
    ("Psi", "Ψ"),
    ("Omega", "Ω"),
];

/// The symbol of a name: "epsilon" is ε, "k1" and "k_1" are k₁, "beta_max" is β_max.
pub(crate) fn symbol(name: &str) -> String {
    let (head, tail) = name.split_once('_').map_or((name, None), |(head, tail)| (head, Some(tail)));
    let stem = head.trim_end_matches(|c: char| c.is_ascii_digit());
    let letter = GREEK.iter().find(|(word, _)| *word == stem).map_or(stem, |(_, letter)| letter);
    let mut symbol = letter.to_owned() + &lowered(&head[stem.len()..]);
    match tail {
        Some(digits) if !digits.is_empty() && digits.bytes().all(|b| b.is_ascii_digit()) => {
            symbol += &lowered(digits);
        }
        Some(words) => symbol = symbol + "_" + words,
        None => {}
    }
    symbol
}

fn lowered(digits: &str) -> String {
    digits.bytes().filter_map(|digit| char::from_u32(u32::from('₀') + u32::from(digit - b'0'))).collect()
}

#[test]
fn names_become_symbols() {
    for (name, shown) in [
        ("epsilon", "ε"),
        ("beta", "β"),
        ("k1", "k₁"),
        ("k_12", "k₁₂"),
        ("alpha2", "α₂"),
        ("beta_max", "β_max"),
        ("kappa1_x", "κ₁_x"),
        ("gain", "gain"),
        ("ε", "ε"),
        ("_", "_"),
        ("7", "₇"),
    ] {
        assert_eq!(symbol(name), shown, "{name}");
    }
}
