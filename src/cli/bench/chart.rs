// SPDX-License-Identifier: MIT OR Apache-2.0
//! Charts as SVG. Text and axes are black on white; the page gives them its own colours.

use plotters::coord::ranged1d::{AsRangedCoord, Ranged, ValueFormatter};
use plotters::prelude::*;
use rarefy::internal::analysis::report::table::{Chart, ChartKind, Series};
use rarefy::{Error, Result};

/// Width and height of every chart, in its own units.
pub const SIZE: (u32, u32) = (720, 400);
/// Room of the legend at the right.
const LEGEND_WIDTH: i32 = 190;
/// Colours that differ for most eyes, and stand out on white and on black (after Okabe and Ito).
const COLORS: [RGBColor; 9] = [
    RGBColor(0, 114, 178),
    RGBColor(230, 159, 0),
    RGBColor(0, 158, 115),
    RGBColor(213, 94, 0),
    RGBColor(204, 121, 167),
    RGBColor(86, 180, 233),
    RGBColor(176, 164, 40),
    RGBColor(127, 96, 180),
    RGBColor(128, 128, 128),
];
const FONT: (&str, i32) = ("sans-serif", 14);

/// The chart as a document of its own.
pub fn svg(chart: &Chart) -> Result<String> {
    let mut text = String::new();
    {
        let root = SVGBackend::with_string(&mut text, SIZE).into_drawing_area();
        root.fill(&WHITE).map_err(failed)?;
        let (plot, legend) = root.split_horizontally(SIZE.0 as i32 - LEGEND_WIDTH);
        match chart.kind {
            ChartKind::StackedBars => bars(chart, &plot)?,
            ChartKind::Lines => {
                let (x, y) = (padded(range(chart, |p| p.0)), padded(range(chart, |p| p.1)));
                lines(chart, &plot, x.0..x.1, y.0..y.1, &decimal, &decimal)?;
            }
            ChartKind::LogLines => {
                let (x, y) = (range(chart, |p| p.0), range(chart, |p| p.1));
                let log = |(least, most): (f64, f64)| (0.8 * least..1.25 * most).log_scale();
                lines(chart, &plot, log(x), log(y), &decimal, &decimal)?;
            }
        }
        draw_legend(chart, &legend)?;
        root.present().map_err(failed)?;
    }
    Ok(accessible(&text, chart))
}

fn failed(error: impl std::fmt::Display) -> Error {
    Error::argument("a chart", error.to_string())
}

/// The document with a role and a title that screen readers say.
fn accessible(svg: &str, chart: &Chart) -> String {
    let title = chart.title.replace('&', "&amp;").replace('<', "&lt;");
    let start = svg.find('>').map_or(0, |at| at + 1);
    let (head, rest) = svg.split_at(start);
    let head = head.trim_end_matches('>');
    format!("{head} role=\"img\" aria-label=\"{}\">\n<title>{title}</title>{rest}", title.replace('"', "&quot;"))
}

fn range(chart: &Chart, of: impl Fn(&(f64, f64)) -> f64) -> (f64, f64) {
    let values = chart.series.iter().flat_map(|series| &series.points).map(of);
    values.fold((f64::INFINITY, f64::NEG_INFINITY), |(least, most), value| (least.min(value), most.max(value)))
}

/// A little more than `range`, so that no point lies on the border; a single value gets room around it.
fn padded((least, most): (f64, f64)) -> (f64, f64) {
    let room = if most > least { 0.06 * (most - least) } else { 0.1 * least.abs().max(1.0) };
    (least - room, most + room)
}

/// A number without digits that say nothing.
fn decimal(value: &f64) -> String {
    let digits = if value.abs() >= 100.0 { 0 } else { 2 };
    let text = format!("{value:.digits$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

type Area<'a, 'b> = DrawingArea<SVGBackend<'a>, plotters::coord::Shift>;

fn lines<X, Y, XR, YR>(
    chart: &Chart,
    area: &Area,
    x: XR,
    y: YR,
    x_label: &dyn Fn(&f64) -> String,
    y_label: &dyn Fn(&f64) -> String,
) -> Result<()>
where
    X: Ranged<ValueType = f64> + ValueFormatter<f64>,
    Y: Ranged<ValueType = f64> + ValueFormatter<f64>,
    XR: AsRangedCoord<CoordDescType = X, Value = f64>,
    YR: AsRangedCoord<CoordDescType = Y, Value = f64>,
{
    let mut context = ChartBuilder::on(area)
        .margin(12)
        .x_label_area_size(44)
        .y_label_area_size(58)
        .build_cartesian_2d(x, y)
        .map_err(failed)?;
    context
        .configure_mesh()
        .label_style(FONT)
        .axis_desc_style(FONT)
        .light_line_style(TRANSPARENT)
        .y_labels(8)
        .x_desc(chart.x_title.as_str())
        .y_desc(chart.y_title.as_str())
        .x_label_formatter(&|v| x_label(v))
        .y_label_formatter(&|v| y_label(v))
        .draw()
        .map_err(failed)?;
    for (at, Series { points, .. }) in chart.series.iter().enumerate() {
        let color = COLORS[at % COLORS.len()];
        context.draw_series(LineSeries::new(points.iter().copied(), color.stroke_width(2))).map_err(failed)?;
        let dots = points.iter().map(|&point| Circle::new(point, 4, color.filled()));
        context.draw_series(dots).map_err(failed)?;
    }
    Ok(())
}

fn bars(chart: &Chart, area: &Area) -> Result<()> {
    let count = chart.categories.len() as f64;
    let most = (0..chart.categories.len())
        .map(|at| chart.series.iter().filter_map(|s| s.points.get(at)).map(|p| p.1).sum::<f64>())
        .fold(0.0, f64::max);
    let mut context = ChartBuilder::on(area)
        .margin(12)
        .x_label_area_size(44)
        .y_label_area_size(58)
        .build_cartesian_2d(-0.5..count - 0.5, 0.0..most)
        .map_err(failed)?;
    let name = |x: &f64| {
        let nearest = x.round();
        let is_middle = (x - nearest).abs() < 1e-6 && nearest >= 0.0;
        let name = is_middle.then(|| chart.categories.get(nearest as usize)).flatten();
        // A path is told by its end.
        name.map_or(String::new(), |name| name.rsplit('/').next().unwrap_or_default().to_owned())
    };
    context
        .configure_mesh()
        .label_style(FONT)
        .axis_desc_style(FONT)
        .disable_x_mesh()
        .light_line_style(TRANSPARENT)
        .x_labels(2 * chart.categories.len() + 1)
        .x_label_formatter(&name)
        .y_desc(chart.y_title.as_str())
        .draw()
        .map_err(failed)?;
    let mut bottoms = vec![0.0; chart.categories.len()];
    for (at, series) in chart.series.iter().enumerate() {
        let color = COLORS[at % COLORS.len()];
        let parts: Vec<_> = series
            .points
            .iter()
            .zip(&mut bottoms)
            .map(|(&(x, y), bottom)| {
                let part = Rectangle::new([(x - 0.35, *bottom), (x + 0.35, *bottom + y)], color.filled());
                *bottom += y;
                part
            })
            .collect();
        context.draw_series(parts).map_err(failed)?;
    }
    Ok(())
}

/// A square and a name for each series, the topmost part of bars first.
fn draw_legend(chart: &Chart, area: &Area) -> Result<()> {
    let mut entries: Vec<(usize, &str)> = chart.series.iter().map(|series| series.name.as_str()).enumerate().collect();
    if chart.kind == ChartKind::StackedBars {
        entries.reverse();
    }
    for (row, (at, name)) in entries.into_iter().enumerate() {
        let y = 24 + 24 * row as i32;
        let square = Rectangle::new([(4, y), (18, y + 14)], COLORS[at % COLORS.len()].filled());
        area.draw(&square).map_err(failed)?;
        let name = name.rsplit('/').next().unwrap_or(name);
        area.draw(&Text::new(name.to_owned(), (26, y), FONT.into_font())).map_err(failed)?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn chart(kind: ChartKind) -> Chart {
        let series = |name: &str, points: &[(f64, f64)]| Series { name: name.into(), points: points.to_vec() };
        Chart {
            id: "c".into(),
            title: "Speed & <size>".into(),
            kind,
            x_title: "size".into(),
            y_title: "ms".into(),
            categories: vec!["cafe".into(), "../scenes/hall".into()],
            series: vec![series("full", &[(0.5, 12.5), (1.0, 30.0)]), series("adaptive", &[(0.5, 10.0), (1.0, 20.0)])],
        }
    }

    #[test]
    fn every_kind_of_chart_names_its_series_and_axes() {
        for kind in [ChartKind::Lines, ChartKind::LogLines] {
            let svg = svg(&chart(kind)).unwrap();
            assert!(svg.starts_with("<svg ") && svg.trim_end().ends_with("</svg>"), "{svg}");
            for words in ["full", "adaptive", "size", "ms", "role=\"img\"", "<title>Speed &amp; &lt;size></title>"] {
                assert!(svg.contains(words), "{kind:?} has no {words}: {svg}");
            }
            assert_eq!(svg.matches("<circle").count(), 4);
            assert!(!svg.contains("NaN") && !svg.contains("inf"), "{svg}");
        }
    }

    #[test]
    fn bars_have_a_part_for_each_series_and_name_their_categories() {
        let mut stacked = chart(ChartKind::StackedBars);
        for series in &mut stacked.series {
            series.points = vec![(0.0, 40.0), (1.0, 60.0)];
        }
        let svg = svg(&stacked).unwrap();
        for color in ["#0072B2", "#E69F00"] {
            // Two bars and the legend.
            assert_eq!(svg.matches(color).count(), 3, "{svg}");
        }
        assert!(svg.contains("cafe") && svg.contains("hall") && !svg.contains("../scenes"), "{svg}");
    }

    #[test]
    fn a_single_point_is_drawn() {
        let mut one = chart(ChartKind::Lines);
        one.series.truncate(1);
        one.series[0].points.truncate(1);
        assert!(svg(&one).unwrap().contains("<circle"));
    }
}
