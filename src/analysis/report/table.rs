// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tables, charts and pictures as values: what every form of a report shows.

use serde::Serialize;

/// What the numbers of a column are, and so how they are written.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Unit {
    /// Milliseconds.
    Milliseconds,
    /// A share of 1, written in percent.
    Percent,
    /// A ratio.
    Times,
    /// Decibels.
    Decibel,
    /// A whole number.
    Count,
    /// A number below 1 with four digits.
    Fine,
}

impl Unit {
    /// `value` as people read it; the unit itself is in the column's title.
    pub fn format(self, value: f64) -> String {
        match self {
            Unit::Milliseconds => grouped(value, 1),
            Unit::Percent => format!("{:.1}", 100.0 * value),
            Unit::Times | Unit::Decibel => format!("{value:.2}"),
            Unit::Count => grouped(value, 0),
            Unit::Fine => format!("{value:.4}"),
        }
    }
}

/// `value` with so many digits after the point, and a comma before every three whole digits.
fn grouped(value: f64, digits: usize) -> String {
    let text = format!("{:.digits$}", value.abs());
    let (whole, rest) = text.split_once('.').map_or((text.as_str(), ""), |(whole, rest)| (whole, rest));
    let mut out = if value < 0.0 { "-".to_owned() } else { String::new() };
    for (at, digit) in whole.chars().enumerate() {
        if at > 0 && (whole.len() - at) % 3 == 0 {
            out.push(',');
        }
        out.push(digit);
    }
    if !rest.is_empty() {
        out.push('.');
        out.push_str(rest);
    }
    out
}

/// A column: its title, with the unit, and what its numbers are.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Column {
    /// What the numbers are, with their unit.
    pub title: String,
    /// How they are written.
    pub unit: Unit,
}

impl Column {
    /// A column of numbers.
    pub fn new(title: impl Into<String>, unit: Unit) -> Self {
        Column { title: title.into(), unit }
    }
}

/// What stands in a row under a column. In JSON a number, a string, or `null` where a figure is missing.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Cell {
    /// A number in the column's unit.
    Number(f64),
    /// Words in place of a number, such as for the PSNR of equal pictures.
    Words(&'static str),
    /// What should have been measured and was not: no report may have one.
    Missing,
}

impl Cell {
    /// A decibel figure, which equal pictures have none of.
    pub fn decibel(value: Option<f64>) -> Self {
        value.map_or(Cell::Words("equal"), Cell::Number)
    }
}

impl From<f64> for Cell {
    fn from(value: f64) -> Self {
        Cell::Number(value)
    }
}

impl From<u64> for Cell {
    fn from(value: u64) -> Self {
        Cell::Number(value as f64)
    }
}

/// A row: what it is about, and a cell for each column.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Row {
    /// What the row is about.
    pub label: String,
    /// In the order of the columns.
    pub cells: Vec<Cell>,
}

/// A table.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Table {
    /// What it shows.
    pub title: String,
    /// What the labels of the rows are.
    pub row_title: String,
    /// The columns.
    pub columns: Vec<Column>,
    /// The rows.
    pub rows: Vec<Row>,
    /// The labels that there must be a row for.
    #[serde(skip)]
    pub expected_rows: Vec<String>,
}

impl Table {
    /// An empty table that is to have a row for each of `labels`.
    pub fn new(
        title: impl Into<String>,
        row_title: impl Into<String>,
        columns: Vec<Column>,
        labels: impl IntoIterator<Item = String>,
    ) -> Self {
        let expected_rows = labels.into_iter().collect();
        Table { title: title.into(), row_title: row_title.into(), columns, rows: Vec::new(), expected_rows }
    }

    /// A table with a row for each of `labels`; `cells` makes what stands in it, or `None` where it was not measured.
    pub fn fill(
        title: impl Into<String>,
        row_title: impl Into<String>,
        columns: Vec<Column>,
        labels: &[String],
        mut cells: impl FnMut(usize) -> Option<Vec<Cell>>,
    ) -> Self {
        let mut table = Table::new(title, row_title, columns, labels.iter().cloned());
        for (at, label) in labels.iter().enumerate() {
            let cells = cells(at).unwrap_or_else(|| vec![Cell::Missing; table.columns.len()]);
            table.rows.push(Row { label: label.clone(), cells });
        }
        table
    }

    /// What is wrong with it, one sentence each: a row or figure that is missing or is no finite number.
    pub fn problems(&self) -> Vec<String> {
        let mut problems = Vec::new();
        let labels: Vec<&String> = self.rows.iter().map(|row| &row.label).collect();
        if labels != self.expected_rows.iter().collect::<Vec<_>>() || labels.is_empty() {
            problems.push(format!("{}: rows {labels:?} in place of {:?}", self.title, self.expected_rows));
        }
        for row in &self.rows {
            if row.cells.len() != self.columns.len() {
                problems.push(format!("{}, {}: {} cells", self.title, row.label, row.cells.len()));
            }
            for (column, cell) in self.columns.iter().zip(&row.cells) {
                match cell {
                    Cell::Number(value) if value.is_finite() => {}
                    Cell::Words(words) if !words.is_empty() => {}
                    other => {
                        problems.push(format!("{}, {}, {}: {other:?}", self.title, row.label, column.title));
                    }
                }
            }
        }
        problems
    }
}

/// How a chart shows its series.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum ChartKind {
    /// Points in the order of the series, joined by lines.
    Lines,
    /// The same with both axes logarithmic.
    LogLines,
    /// A bar for each category, of one part for each series.
    StackedBars,
}

/// A series of a chart.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Series {
    /// Its name in the legend.
    pub name: String,
    /// x and y; for bars, x is the category's index.
    pub points: Vec<(f64, f64)>,
}

/// A chart of numbers that the tables have.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Chart {
    /// Name of its file.
    pub id: String,
    /// What it shows.
    pub title: String,
    /// How.
    pub kind: ChartKind,
    /// What x is, with its unit.
    pub x_title: String,
    /// What y is, with its unit.
    pub y_title: String,
    /// The bars, for a chart of bars.
    pub categories: Vec<String>,
    /// The series.
    pub series: Vec<Series>,
}

impl Chart {
    /// What is wrong with it: no series, an empty one, a number that is not finite.
    pub fn problems(&self) -> Vec<String> {
        let bad = |s: &Series| s.points.is_empty() || s.points.iter().any(|(x, y)| !x.is_finite() || !y.is_finite());
        let mut problems: Vec<String> =
            self.series.iter().filter(|s| bad(s)).map(|s| format!("{}: series {}", self.title, s.name)).collect();
        if self.series.is_empty() {
            problems.push(format!("{}: no series", self.title));
        }
        problems
    }
}

/// A picture of a report: a PNG file beside it.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, serde::Deserialize)]
pub struct Picture {
    /// Its path from the report's folder, with `/`.
    pub file: String,
    /// Width in pixels.
    pub width: u32,
    /// Height in pixels.
    pub height: u32,
    /// What there is to see, for who cannot see it.
    pub alt: String,
    /// What stands below it.
    pub caption: String,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_written_in_their_unit() {
        assert_eq!(Unit::Milliseconds.format(1_234_567.26), "1,234,567.3");
        assert_eq!(Unit::Milliseconds.format(-999.0), "-999.0");
        assert_eq!(Unit::Count.format(1000.0), "1,000");
        assert_eq!(Unit::Percent.format(0.3457), "34.6");
        assert_eq!(Unit::Times.format(2.0449), "2.04");
        assert_eq!(Unit::Fine.format(0.00264), "0.0026");
    }

    #[test]
    fn a_missing_row_or_figure_is_a_problem() {
        let columns = vec![Column::new("a", Unit::Times), Column::new("b", Unit::Decibel)];
        let labels = ["one".to_owned(), "two".to_owned()];
        let good = Table::fill("t", "row", columns, &labels, |_| Some(vec![1.0.into(), Cell::decibel(None)]));
        assert!(good.problems().is_empty(), "{:?}", good.problems());
        let broken = |change: &dyn Fn(&mut Table)| {
            let mut table = good.clone();
            change(&mut table);
            table.problems().len()
        };
        assert_eq!(broken(&|t| t.rows.truncate(1)), 1);
        assert_eq!(broken(&|t| t.rows.clear()), 1);
        assert_eq!(broken(&|t| t.rows.swap(0, 1)), 1);
        assert_eq!(broken(&|t| t.rows[1].cells[0] = Cell::Missing), 1);
        assert_eq!(broken(&|t| t.rows[0].cells[1] = Cell::Number(f64::NAN)), 1);
        assert_eq!(broken(&|t| t.rows[0].cells[0] = Cell::Number(f64::INFINITY)), 1);
        assert_eq!(broken(&|t| t.rows[0].cells.truncate(1)), 1);
        let none = Table::fill("t", "row", good.columns.clone(), &labels, |at| (at == 0).then(|| vec![1.0.into(); 2]));
        assert_eq!(none.problems().len(), 2);
    }

    #[test]
    fn a_chart_without_numbers_is_a_problem() {
        let chart = |points: Vec<(f64, f64)>| Chart {
            id: "c".into(),
            title: "c".into(),
            kind: ChartKind::Lines,
            x_title: "x".into(),
            y_title: "y".into(),
            categories: Vec::new(),
            series: vec![Series { name: "s".into(), points }],
        };
        assert!(chart(vec![(0.0, 1.0)]).problems().is_empty());
        assert_eq!(chart(vec![(0.0, f64::NAN)]).problems().len(), 1);
        assert_eq!(chart(Vec::new()).problems().len(), 1);
    }
}
