//! Writes `docs/validation.md`: every exact answer against what malus gets. Minutes of work, so it is run by hand:
//!
//! `cargo run --release --example validate > docs/validation.md`, or its part on stopping alone with `-- stopping`.
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

fn table(title: &str, text: &str, rows: &[Row]) {
    println!("\n## {title}\n\n{text}\n");
    println!("| answer | source | expected | got | error | z | test |");
    println!("|---|---|---|---|---|---|---|");
    rows.iter().for_each(Row::print);
}

fn main() {
    // The parts that take longest can be had alone.
    match std::env::args().nth(1).as_deref() {
        Some("intervals") => return coverage::print(),
        Some("stopping") => return stopping::print(),
        Some("studies") => return studies::print(),
        _ => {}
    }
    println!("# Validation\n");
    println!("Every exact answer that malus is held against, and what it gets.");
    println!(
        "Made by `cargo run --release --example validate > docs/validation.md`; seeds are fixed, so all but the times of the last table come out the same everywhere."
    );
    println!(
        "z is the deviation in standard errors; where nothing is left to chance the relative deviation stands in its place."
    );
    println!("The test named asserts the same, at fewer samples where that saves minutes.");
    table(
        "Fresnel reflection",
        "Amplitudes at a plane surface, from the stable forms; nothing is left to chance.",
        &fresnel::rows(),
    );
    table(
        "Rooms",
        "Illuminance by Monte Carlo.\nFor the paper's room at a = 0 the reference itself is known to 4e-5, at a = 1 to half of its last digit; both are in the error.",
        &rooms::rows(),
    );
    table(
        "Furnaces and CIE 171",
        "Closed rooms whose walls emit, and cases in the spirit of CIE 171:2006.",
        &closed::rows(),
    );
    figure::print();
    coverage::print();
    stopping::print();
    studies::print();
    baseline::print();
}
