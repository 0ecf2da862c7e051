//! Writes `docs/validation.md`: every exact answer against what malus gets. An hour of work, so it is run by hand:
//!
//! `cargo run --release --example validate > docs/validation.md`, or some of its parts alone: `-- answers stopping`.
#![expect(
    clippy::unwrap_used,
    reason = "a document that cannot be made is to panic"
)]

mod baseline;
mod closed;
mod coverage;
mod figure;
mod fresnel;
mod rooms;
mod stopping;
mod studies;

/// One line of a table: an exact answer and what came out.
struct Row {
    what: String,
    source: &'static str,
    expected: f64,
    got: f64,
    /// Standard error, with the uncertainty of the expected value; 0 where nothing is left to chance.
    error: f64,
    test: &'static str,
}

impl Row {
    fn print(&self) {
        let Self {
            what,
            source,
            expected,
            got,
            error,
            test,
        } = self;
        let (error, z) = if *error > 0.0 {
            (
                format!("{error:.1e}"),
                format!("{:+.2}", (got - expected) / error),
            )
        } else {
            let scale = expected.abs().max(f64::MIN_POSITIVE);
            (
                "exact".into(),
                format!("off by {:.0e}", (got - expected).abs() / scale),
            )
        };
        println!("| {what} | {source} | {expected:.8} | {got:.8} | {error} | {z} | `{test}` |");
    }
}

fn table(title: &str, text: &str, rows: impl IntoIterator<Item = Row>) {
    println!("\n## {title}\n\n{text}\n");
    println!("| answer | source | expected | got | error | z | test |");
    println!("|---|---|---|---|---|---|---|");
    for row in rows {
        row.print();
    }
}

/// The parts of the document, in its order.
const PARTS: [(&str, fn()); 7] = [
    ("answers", answers),
    ("figure", figure::print),
    ("planes", planes),
    ("intervals", coverage::print),
    ("stopping", stopping::print),
    ("studies", studies::print),
    ("baseline", baseline::print),
];

fn main() {
    let asked: Vec<String> = std::env::args().skip(1).collect();
    let known = |name: &String| PARTS.iter().any(|part| part.0 == name);
    if let Some(other) = asked.iter().find(|name| !known(name)) {
        let names = PARTS.map(|part| part.0).join(", ");
        eprintln!("error: no part is called {other:?}; there are {names}");
        std::process::exit(2);
    }
    for (name, print) in PARTS {
        if asked.is_empty() || asked.iter().any(|it| it == name) {
            print();
        }
    }
}

fn planes() {
    table(
        "Two infinite planes",
        "A box whose side walls are ideal mirrors, with a point source in its middle: mean of the floor's 8 × 8 points over 2π I₀.",
        rooms::planes(),
    );
}

fn answers() {
    println!("# Validation\n");
    println!("Every exact answer that malus is held against, and what it gets.");
    println!(
        "Made by `cargo run --release --example validate > docs/validation.md`, or in parts that are put together (`-- answers`, and so on); seeds are fixed, so all but the times of the last table come out the same everywhere."
    );
    println!(
        "z is the deviation in standard errors; where nothing is left to chance the relative deviation stands in its place."
    );
    println!("The test named asserts the same, at fewer samples where that saves minutes.");
    table(
        "Fresnel reflection",
        "Amplitudes at a plane surface, from the stable forms; nothing is left to chance.",
        fresnel::rows(),
    );
    table(
        "Rooms",
        "Illuminance by Monte Carlo.\nFor the paper's room at a = 0 the reference itself is known to 4e-5, at a = 1 to half of its last digit; both are in the error.",
        rooms::rows(),
    );
    table(
        "Furnaces and CIE 171",
        "Closed rooms whose walls emit, and cases in the spirit of CIE 171:2006.",
        closed::rows(),
    );
}
