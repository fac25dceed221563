//! Plots as SVG, for pages: points and lines over linear or logarithmic axes.
//!
//! Colours are those of Okabe and Ito (2008), which the colour-blind can distinguish, and every series has
//! a shape of its own besides, for print in grey.

use std::fmt::Write;

use crate::html::escape;
use harness::numbers::{decimal, superscript};

/// A plot, drawn by [`Plot::svg`].
#[derive(Debug, Clone, PartialEq)]
pub struct Plot {
    /// Across.
    pub x: Axis,
    /// Up.
    pub y: Axis,
    /// What is plotted, in the order of the legend.
    pub series: Vec<Series>,
    /// Corners of a staircase below which nothing lies, drawn behind everything.
    pub staircase: Vec<(f64, f64)>,
}

/// One of the two axes.
#[derive(Debug, Clone, PartialEq)]
pub struct Axis {
    /// Quantity and unit.
    pub name: String,
    /// How numbers are spread over it.
    pub scale: Scale,
}

/// How numbers are spread over an axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Scale {
    /// Evenly from 0.
    Linear,
    /// Decades; what is not above 0 is on a rail of its own at the axis' beginning.
    Log,
}

/// Marks that belong together.
#[derive(Debug, Clone, PartialEq)]
pub struct Series {
    /// In the legend; series of one name have one entry there, without a name none.
    pub name: String,
    /// Its colour and shape.
    pub style: Style,
    /// Whether a line joins the marks, in their order.
    pub joined: bool,
    /// The marks.
    pub marks: Vec<Mark>,
}

/// An index into the lists of colours and of shapes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Style(pub usize);

/// A point.
#[derive(Debug, Clone, PartialEq)]
pub struct Mark {
    /// Across.
    pub x: f64,
    /// Up.
    pub y: f64,
    /// What it means.
    pub kind: Kind,
    /// Its tooltip.
    pub text: String,
}

/// What a mark means.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// One of a series.
    Plain,
    /// The one that matters: larger, with a ring.
    Preset,
    /// Another quantity: hollow.
    Hollow,
    /// One with a caveat: crossed out.
    Flagged,
}

/// Okabe and Ito's colours without yellow, which white paper swallows; then plum, grey and olive.
const COLORS: [&str; 10] = [
    "#d55e00", "#0072b2", "#009e73", "#cc79a7", "#7b3f7d", "#e69f00", "#56b4e9", "#000000",
    "#7f7f7f", "#999933",
];

/// Size of the plot in pixels of CSS, the legend at its right included.
const SIZE: (f64, f64) = (860.0, 360.0);
const LEFT: f64 = 70.0;
const RIGHT: f64 = 500.0;
const TOP: f64 = 26.0;
const BOTTOM: f64 = 310.0;

/// Between a logarithmic axis' rail of zeros and its first decade.
const RAIL: f64 = 22.0;

/// One line through points, in the order given, over axes that start at 0.
pub fn line_plot(points: &[(f64, f64)], x_name: &str, y_name: &str) -> String {
    let axis = |name: &str| Axis { name: name.to_owned(), scale: Scale::Linear };
    let mark = |&(x, y): &(f64, f64)| {
        let text = format!("{}: {}", decimal(x), decimal(y));
        Mark { x, y, kind: Kind::Plain, text }
    };
    let marks = points.iter().map(mark).collect();
    let series = Series { name: String::new(), style: Style(1), joined: true, marks };
    Plot { x: axis(x_name), y: axis(y_name), series: vec![series], staircase: Vec::new() }.svg()
}

impl Plot {
    /// The drawing, without any reference outside itself. Marks that are no numbers are left out:
    /// name them next to the plot.
    pub fn svg(&self) -> String {
        let marks = || self.series.iter().flat_map(|series| &series.marks);
        let across = Span::new(self.x.scale, marks().map(|mark| mark.x), (LEFT, RIGHT));
        let up = Span::new(self.y.scale, marks().map(|mark| mark.y), (BOTTOM, TOP));
        let (width, height) = SIZE;
        let mut svg = format!(
            "<svg viewBox=\"0 0 {width} {height}\" width=\"{width}\" height=\"{height}\" role=\"img\" \
             font-size=\"12\" font-family=\"system-ui, sans-serif\">\n"
        );
        grid(&mut svg, &across, &up);
        text(&mut svg, (0.5 * (LEFT + RIGHT), BOTTOM + 38.0), "middle", &self.x.name);
        text(&mut svg, (LEFT - 56.0, TOP - 12.0), "start", &self.y.name);

        let position = |x: f64, y: f64| Some((across.position(x)?, up.position(y)?));
        staircase(&mut svg, &self.staircase, &across, &up);
        for series in self.series.iter().filter(|series| series.joined) {
            let points: Vec<_> = series
                .marks
                .iter()
                .filter_map(|mark| position(mark.x, mark.y))
                .map(|(x, y)| format!("{x:.1},{y:.1}"))
                .collect();
            let _ = writeln!(
                svg,
                "<polyline points=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"1.5\"/>",
                points.join(" "),
                series.style.color()
            );
        }
        for series in &self.series {
            for mark in &series.marks {
                if let Some(at) = position(mark.x, mark.y) {
                    symbol(&mut svg, at, series.style, mark.kind, &mark.text);
                }
            }
        }
        self.legend(&mut svg);
        svg + "</svg>\n"
    }

    fn legend(&self, svg: &mut String) {
        let mut names: Vec<&str> = Vec::new();
        for series in &self.series {
            if series.name.is_empty() || names.contains(&series.name.as_str()) {
                continue;
            }
            let y = TOP + 8.0 + 20.0 * names.len() as f64;
            symbol(svg, (RIGHT + 24.0, y), series.style, Kind::Plain, "");
            text(svg, (RIGHT + 36.0, y + 4.0), "start", &series.name);
            names.push(&series.name);
        }
    }
}

impl Style {
    fn color(self) -> &'static str {
        COLORS[self.0 % COLORS.len()]
    }

    /// The outline of this style's shape around the origin.
    fn outline(self, size: f64) -> String {
        let s = size;
        match self.0 % 6 {
            0 => format!("M{s} 0A{s} {s} 0 1 1 -{s} 0A{s} {s} 0 1 1 {s} 0Z"),
            1 => format!("M-{s} -{s}H{s}V{s}H-{s}Z"),
            2 => format!("M0 -{b}L{b} 0L0 {b}L-{b} 0Z", b = 1.35 * s),
            3 => format!("M0 -{b}L{b} {s}H-{b}Z", b = 1.25 * s),
            4 => format!("M0 {b}L{b} -{s}H-{b}Z", b = 1.25 * s),
            _ => {
                format!("M-{s} -{h}L0 -{b}L{s} -{h}V{h}L0 {b}L-{s} {h}Z", h = 0.6 * s, b = 1.2 * s)
            }
        }
    }
}

/// The numbers that an axis shows, and where on the page it lies.
struct Span {
    scale: Scale,
    least: f64,
    most: f64,
    /// Where `least` and `most` lie.
    from: f64,
    to: f64,
    /// Where zeros lie on a logarithmic axis that has any.
    rail: Option<f64>,
}

impl Span {
    fn new(
        scale: Scale,
        values: impl Iterator<Item = f64> + Clone,
        (from, to): (f64, f64),
    ) -> Self {
        let finite = values.filter(|value| value.is_finite());
        let most = finite.clone().fold(0.0, f64::max);
        match scale {
            Scale::Linear => {
                let most = if most > 0.0 { most } else { 1.0 };
                Self { scale, least: 0.0, most, from, to, rail: None }
            }
            Scale::Log => {
                let has_zeros = finite.clone().any(|value| value <= 0.0);
                let least =
                    finite.filter(|&value| value > 0.0).fold(f64::INFINITY, f64::min).min(most);
                let (least, most) = if most > 0.0 { decades(least, most) } else { (1.0, 10.0) };
                let inward = RAIL * (to - from).signum();
                let rail = has_zeros.then_some(from);
                let from = if has_zeros { from + inward } else { from };
                Self { scale, least, most, from, to, rail }
            }
        }
    }

    fn position(&self, value: f64) -> Option<f64> {
        if !value.is_finite() {
            return None;
        }
        let share = match self.scale {
            Scale::Linear => value / self.most,
            Scale::Log if value <= 0.0 => return self.rail,
            Scale::Log => (value / self.least).log10() / (self.most / self.least).log10(),
        };
        Some(self.from + share * (self.to - self.from))
    }

    /// Numbers to write at the axis.
    fn ticks(&self) -> Vec<f64> {
        match self.scale {
            Scale::Linear => (0..=4).map(|step| 0.25 * f64::from(step) * self.most).collect(),
            Scale::Log => {
                let (first, last) = (self.least.log10(), self.most.log10());
                let decades = (first.ceil() as i32)..=(last.floor() as i32);
                let every = ((last - first) / 7.0).ceil().max(1.0) as usize;
                let steps: &[f64] = if last - first < 2.5 { &[1.0, 2.0, 5.0] } else { &[1.0] };
                let within = |value: &f64| (self.least..=self.most * 1.000_001).contains(value);
                let down = first.floor() as i32..first.ceil() as i32;
                down.chain(decades)
                    .step_by(every)
                    .flat_map(|decade| steps.iter().map(move |step| step * 10f64.powi(decade)))
                    .filter(within)
                    .collect()
            }
        }
    }
}

/// The range of a logarithmic axis: out to 1, 2 or 5 times a power of ten.
fn decades(least: f64, most: f64) -> (f64, f64) {
    let power = |value: f64| 10f64.powf(value.log10().floor());
    let low = [5.0, 2.0, 1.0]
        .map(|step| step * power(least))
        .into_iter()
        .find(|&low| low <= least)
        .unwrap_or(least);
    let high = [1.0, 2.0, 5.0, 10.0]
        .map(|step| step * power(most))
        .into_iter()
        .find(|&high| high >= most)
        .unwrap_or(most);
    if high > low { (low, high) } else { (low, 2.0 * low) }
}

fn grid(svg: &mut String, across: &Span, up: &Span) {
    let lines = |svg: &mut String, path: String| {
        let _ = writeln!(svg, "<path d=\"{path}\" fill=\"none\" stroke=\"#e4e7ea\"/>");
    };
    for tick in across.ticks() {
        let Some(x) = across.position(tick) else { continue };
        lines(svg, format!("M{x:.1} {TOP}V{BOTTOM}"));
        text(svg, (x, BOTTOM + 18.0), "middle", &tick_text(tick, across.scale));
    }
    for tick in up.ticks() {
        let Some(y) = up.position(tick) else { continue };
        lines(svg, format!("M{LEFT} {y:.1}H{RIGHT}"));
        text(svg, (LEFT - 8.0, y + 4.0), "end", &tick_text(tick, up.scale));
    }
    if let Some(x) = across.rail {
        text(svg, (x, BOTTOM + 18.0), "middle", "0");
    }
    if let Some(y) = up.rail {
        text(svg, (LEFT - 8.0, y + 4.0), "end", "0");
    }
    let _ = writeln!(
        svg,
        "<path d=\"M{LEFT} {TOP}V{BOTTOM}H{RIGHT}\" fill=\"none\" stroke=\"#57606a\"/>"
    );
}

fn tick_text(value: f64, scale: Scale) -> String {
    match scale {
        Scale::Linear => decimal(value),
        Scale::Log if (0.01..10_000.0).contains(&value) => format!("{value}"),
        Scale::Log => {
            let exponent = value.log10().floor();
            let digit = (value / 10f64.powf(exponent)).round();
            format!(
                "{}10{}",
                if digit == 1.0 { String::new() } else { format!("{digit}·") },
                superscript(&exponent.to_string())
            )
        }
    }
}

/// From each corner on to the right, then down to the next.
fn staircase(svg: &mut String, corners: &[(f64, f64)], across: &Span, up: &Span) {
    let mut path = String::new();
    for &(x, y) in corners {
        if let (Some(x), Some(y)) = (across.position(x), up.position(y)) {
            let start = if path.is_empty() { format!("M{x:.1} {TOP}") } else { format!("H{x:.1}") };
            let _ = write!(path, "{start}V{y:.1}");
        }
    }
    if !path.is_empty() {
        let _ = writeln!(
            svg,
            "<path d=\"{path}H{RIGHT}\" fill=\"none\" stroke=\"#8b949e\" stroke-width=\"1.2\" \
             stroke-dasharray=\"5 3\"/>"
        );
    }
}

fn symbol(svg: &mut String, (x, y): (f64, f64), style: Style, kind: Kind, tooltip: &str) {
    let color = style.color();
    let (size, fill) = match kind {
        Kind::Plain | Kind::Flagged => (4.0, color),
        Kind::Preset => (5.5, color),
        Kind::Hollow => (4.5, "#ffffff"),
    };
    let _ =
        write!(svg, "<g transform=\"translate({x:.1} {y:.1})\"><title>{}</title>", escape(tooltip));
    if kind == Kind::Preset {
        let _ = write!(svg, "<circle r=\"9\" fill=\"none\" stroke=\"{color}\"/>");
    }
    let _ = write!(
        svg,
        "<path d=\"{}\" fill=\"{fill}\" stroke=\"{color}\" stroke-width=\"1.2\"/>",
        style.outline(size)
    );
    if kind == Kind::Flagged {
        let _ = write!(svg, "<path d=\"M-7 -7L7 7M-7 7L7 -7\" stroke=\"{color}\"/>");
    }
    let _ = writeln!(svg, "</g>");
}

fn text(svg: &mut String, (x, y): (f64, f64), anchor: &str, text: &str) {
    let text = escape(text);
    let _ = writeln!(
        svg,
        "<text x=\"{x:.1}\" y=\"{y:.1}\" text-anchor=\"{anchor}\" fill=\"#1b1f24\">{text}</text>"
    );
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plot(scale: Scale, points: &[(f64, f64)]) -> Plot {
        let axis = |name: &str| Axis { name: name.to_owned(), scale };
        let mark =
            |&(x, y): &(f64, f64)| Mark { x, y, kind: Kind::Plain, text: "point".to_owned() };
        let marks = points.iter().map(mark).collect();
        let series =
            Series { name: "balls < all".to_owned(), style: Style(1), joined: true, marks };
        Plot { x: axis("x"), y: axis("y"), series: vec![series], staircase: Vec::new() }
    }

    #[test]
    fn the_largest_point_of_a_linear_plot_is_at_the_corner() {
        let svg = plot(Scale::Linear, &[(1.0, 50.0), (2.0, 200.0)]).svg();
        assert!(svg.contains("points=\"285.0,239.0 500.0,26.0\""), "{svg}");
        assert!(svg.contains("balls &lt; all"));
    }

    #[test]
    fn decades_are_evenly_spaced_and_zeros_have_a_rail() {
        let svg = plot(Scale::Log, &[(1.0, 1.0), (10.0, 100.0), (100.0, 0.0)]).svg();
        // Halfway across and at the top; zero at the bottom.
        assert!(svg.contains("70.0,288.0 285.0,26.0 500.0,310.0"), "{svg}");
        assert!(svg.contains(">0</text>") && svg.contains(">100</text>"));
        let without = plot(Scale::Log, &[(1.0, 1.0), (10.0, 100.0)]).svg();
        assert!(!without.contains(">0</text>"));
    }

    #[test]
    fn nothing_to_plot_is_an_empty_plot() {
        for scale in [Scale::Linear, Scale::Log] {
            for points in [&[][..], &[(0.0, 0.0)], &[(f64::NAN, f64::INFINITY)], &[(3.0, 3.0)]] {
                let svg = plot(scale, points).svg();
                assert!(!svg.contains("NaN") && !svg.contains("inf"), "{svg}");
            }
        }
    }

    #[test]
    fn ticks_lie_on_the_axis() {
        let ticks =
            |least, most| Span::new(Scale::Log, [least, most].into_iter(), (0.0, 1.0)).ticks();
        assert_eq!(ticks(3.0, 40.0), [2.0, 5.0, 10.0, 20.0, 50.0]);
        assert_eq!(ticks(1e-3, 1e2).len(), 6);
        assert!(ticks(1e-12, 1e3).len() <= 9);
        assert_eq!(tick_text(2e-7, Scale::Log), "2·10⁻⁷");
        assert_eq!(tick_text(1e6, Scale::Log), "10⁶");
    }

    #[test]
    fn a_staircase_goes_down_to_the_right() {
        let mut plot = plot(Scale::Linear, &[(0.0, 0.0), (2.0, 2.0)]);
        plot.staircase = vec![(1.0, 2.0), (2.0, 1.0)];
        assert!(plot.svg().contains("d=\"M285.0 26V26.0H500.0V168.0H500\""), "{}", plot.svg());
    }
}
