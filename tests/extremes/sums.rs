//! Sums of thousands of millions of walks.

use malus_estimator::{REPLICAS, Tally};

/// 10⁹ walks of 0.1, which binary numbers cannot hold: rounding stays below 10⁻⁹ of the mean, since each replica sums its
/// own share. (Single precision stagnates after 10⁷.)
#[test]
fn a_thousand_million_walks_add_up() {
    let walks = 1_000_000_000_u64.div_ceil(u64::from(REPLICAS));
    let mut tally = Tally::new(0..REPLICAS, 1);
    for replica in tally.replicas_mut() {
        for _ in 0..walks {
            replica.sums[0] += 0.1;
        }
        replica.points = walks;
    }
    let estimate = tally.estimate(|means| means.at(0));
    let relative = (estimate.mean - 0.1).abs() / 0.1;
    assert!(relative < 1e-9, "{relative:e}");
    assert!(
        estimate.standard_error < 1e-15,
        "{}",
        estimate.standard_error
    );
}
