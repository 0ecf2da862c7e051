//! `variants.parquet`, where the program is built with it.

use super::{folder, sweep};
use crate::cli::{assert_told, stderr};

/// A key of numbers, one of words, and a variant that fails.
const STUDY: &str = "[grid]\n\"material.plaster.a\" = [0.1, 1.5, 0.6]\n\"run.model\" = [\"polarised\", \"scalar\"]\n";

#[cfg(not(feature = "parquet"))]
#[test]
fn a_program_without_parquet_says_how_to_build_one_with_it() {
    let folder = folder(STUDY, &[]);
    let output = sweep(&folder, &["--parquet"]);
    assert_eq!(output.status.code(), Some(2));
    assert_told(&stderr(&output), &["--parquet: ", "--features parquet"]);
    assert!(!folder.path("out").exists(), "results beside an error");
}

#[cfg(feature = "parquet")]
#[test]
fn parquet_holds_what_the_table_holds() {
    use parquet::file::reader::SerializedFileReader;
    use parquet::record::Field;

    let folder = folder(STUDY, &[]);
    let output = sweep(&folder, &["--parquet", "--quiet"]);
    assert_told(&stderr(&output), &["2 of 6 variants failed: 003, 004"]);
    let text = folder.text("out/variants.csv");
    let mut table = csv::Reader::from_reader(text.as_bytes());
    let file = std::fs::File::open(folder.path("out/variants.parquet")).unwrap();
    let mut rows = SerializedFileReader::new(file).unwrap().into_iter();
    let header = table.headers().unwrap().clone();
    for record in table.records() {
        let (record, row) = (record.unwrap(), rows.next().unwrap().unwrap());
        let columns: Vec<_> = row.get_column_iter().collect();
        assert!(
            columns
                .iter()
                .map(|(name, _)| name.as_str())
                .eq(header.iter())
        );
        for ((name, field), text) in columns.into_iter().zip(&record) {
            match field {
                Field::Null => assert_eq!(text, "", "{name}"),
                Field::Double(number) => assert_eq!(text.parse(), Ok(*number), "{name}"),
                Field::Str(found) => {
                    assert!(["variant", "run.model", "status"].contains(&name.as_str()));
                    assert_eq!(found, text, "{name}");
                }
                other => panic!("{name}: {other:?}"),
            }
        }
    }
    assert!(rows.next().is_none());
    let written =
        |name: &str| std::fs::read(folder.path(&format!("{name}/variants.parquet"))).unwrap();
    for shard in ["2/2", "1/2"] {
        sweep(&folder, &["--parquet", "--quiet", "--shard", shard]);
    }
    folder.malus(&["merge", "out", "-o", "merged", "--quiet"]);
    assert_eq!(written("out"), written("merged"));
}
