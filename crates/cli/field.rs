//! A quantity over the cells of a grid, and between their centres.

use crate::contour::Lattice;

/// Values at the centres of the cells of a grid; a position is counted in cells from the grid's corner.
#[derive(Clone, Debug)]
pub struct Field {
    counts: [usize; 2],
    values: Vec<Option<f64>>,
}

impl Field {
    /// A field of `counts[0]` × `counts[1]` cells, the first index fastest; `None` where there is no value.
    ///
    /// None if the number of values is another.
    pub fn new(counts: [usize; 2], values: Vec<Option<f64>>) -> Option<Self> {
        let fits = counts[0].checked_mul(counts[1]) == Some(values.len());
        (fits && !values.is_empty()).then_some(Self { counts, values })
    }

    /// Cells along each side.
    pub fn counts(&self) -> [usize; 2] {
        self.counts
    }

    /// Least and greatest value, if there is any.
    pub fn range(&self) -> Option<[f64; 2]> {
        self.values
            .iter()
            .flatten()
            .fold(None, |range, &value| match range {
                None => Some([value, value]),
                Some([low, high]) => Some([low.min(value), high.max(value)]),
            })
    }

    /// Mean of the values; 0 where there is none.
    pub fn mean(&self) -> f64 {
        let count = self.values.iter().flatten().count();
        self.values.iter().flatten().sum::<f64>() / count.max(1) as f64
    }

    /// The value in between the cells' centres, bilinear; beyond the outermost centres it stays as it is there.
    ///
    /// `None` inside a cell without a value; beside such a cell only those that have one count.
    pub fn at(&self, position: [f64; 2]) -> Option<f64> {
        let own = self.cell([0, 1].map(|side| position[side].max(0.0) as usize));
        own?;
        let [first, second] = [0, 1].map(|side| {
            let last = (self.counts[side] - 1) as f64;
            let place = (position[side] - 0.5).clamp(0.0, last);
            let below = place.floor();
            [
                (below as usize, 1.0 - (place - below)),
                (below as usize + 1, place - below),
            ]
        });
        let (mut sum, mut weights) = (0.0, 0.0);
        for (i, first_weight) in first {
            for (j, second_weight) in second {
                let weight = first_weight * second_weight;
                if weight > 0.0
                    && let Some(value) = self.cell([i, j])
                {
                    sum += weight * value;
                    weights += weight;
                }
            }
        }
        if weights > 0.0 {
            Some(sum / weights)
        } else {
            own
        }
    }

    /// The field at the corners of `fineness` × `fineness` parts of each cell.
    pub fn lattice(&self, fineness: usize) -> Lattice {
        let [columns, rows] = self.counts.map(|count| count * fineness + 1);
        let fine = fineness as f64;
        let values = (0..rows)
            .flat_map(|row| (0..columns).map(move |column| [column, row]))
            .map(|corner| self.at(corner.map(|index| index as f64 / fine)))
            .collect();
        Lattice { columns, values }
    }

    /// Value of a cell; indices beyond the last mean the last.
    fn cell(&self, index: [usize; 2]) -> Option<f64> {
        let [i, j] = [0, 1].map(|side| index[side].min(self.counts[side] - 1));
        self.values[j * self.counts[0] + i]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_field_is_bilinear_between_centres_and_flat_beyond() {
        let field = Field::new([2, 2], [0.0, 1.0, 2.0, 3.0].map(Some).to_vec()).expect("four");
        assert_eq!(field.at([0.5, 0.5]), Some(0.0));
        assert_eq!(field.at([1.5, 1.5]), Some(3.0));
        assert_eq!(field.at([1.0, 1.0]), Some(1.5));
        assert_eq!(field.at([1.0, 0.0]), Some(0.5));
        assert_eq!(field.at([2.0, 2.0]), Some(3.0));
        assert_eq!(field.range(), Some([0.0, 3.0]));
        assert!((field.mean() - 1.5).abs() < 1e-15);
    }

    #[test]
    fn a_cell_without_a_value_spreads_nothing() {
        let values = vec![Some(1.0), None, Some(1.0), Some(1.0)];
        let field = Field::new([2, 2], values).expect("four");
        assert_eq!(field.at([0.9, 0.9]), Some(1.0));
        assert_eq!(field.at([1.1, 0.9]), None);
    }

    #[test]
    fn values_that_do_not_fit_the_grid_make_no_field() {
        assert!(Field::new([2, 2], vec![Some(1.0); 3]).is_none());
        assert!(Field::new([0, 2], Vec::new()).is_none());
    }
}
