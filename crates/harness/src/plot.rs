//! Line plots as SVG, for pages.

use std::fmt::Write;

use crate::html::escape;
use crate::numbers::decimal;

/// Size of the plot in pixels of CSS, and of the margins that hold its numbers.
const SIZE: (f64, f64) = (480.0, 240.0);
const MARGIN: f64 = 46.0;

/// A line through points, in the order given. Both axes start at 0; each point has its numbers as a
/// tooltip.
pub fn line_plot(points: &[(f64, f64)], x_name: &str, y_name: &str) -> String {
    let most = |of: fn(&(f64, f64)) -> f64| points.iter().map(of).fold(0.0, f64::max);
    let (x_most, y_most) = (most(|point| point.0), most(|point| point.1));
    let (right, bottom) = (SIZE.0 - MARGIN, SIZE.1 - MARGIN);
    let share = |value: f64, most: f64| value / most.max(f64::MIN_POSITIVE);
    let place = |&(x, y): &(f64, f64)| {
        let across = MARGIN + (right - MARGIN) * share(x, x_most);
        let down = bottom - (bottom - MARGIN) * share(y, y_most);
        (across, down)
    };

    let (width, height) = SIZE;
    let mut svg = format!(
        "<svg viewBox=\"0 0 {width} {height}\" width=\"{width}\" height=\"{height}\" role=\"img\" \
         font-size=\"12\" fill=\"#57606a\">\n\
         <path d=\"M{MARGIN} {MARGIN}V{bottom}H{right}\" fill=\"none\" stroke=\"#8b949e\"/>\n"
    );
    let mut label = |x: f64, y: f64, anchor: &str, text: &str| {
        let text = escape(text);
        let _ = writeln!(svg, "<text x=\"{x}\" y=\"{y}\" text-anchor=\"{anchor}\">{text}</text>");
    };
    label(MARGIN, MARGIN - 12.0, "start", y_name);
    label(MARGIN - 6.0, MARGIN + 4.0, "end", &decimal(y_most));
    label(MARGIN - 6.0, bottom + 4.0, "end", "0");
    label(MARGIN, bottom + 18.0, "middle", "0");
    label(right, bottom + 18.0, "middle", &decimal(x_most));
    label(0.5 * (MARGIN + right), bottom + 34.0, "middle", x_name);

    let steps: Vec<_> = points.iter().map(place).map(|(x, y)| format!("{x:.1},{y:.1}")).collect();
    let _ = writeln!(
        svg,
        "<polyline points=\"{}\" fill=\"none\" stroke=\"#08519c\" stroke-width=\"2\"/>",
        steps.join(" ")
    );
    for point in points {
        let (x, y) = place(point);
        let _ = writeln!(
            svg,
            "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"4\" fill=\"#08519c\"><title>{}: {}</title>\
             </circle>",
            decimal(point.0),
            decimal(point.1)
        );
    }
    svg + "</svg>\n"
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_largest_point_is_at_the_corner() {
        let svg = line_plot(&[(1.0, 50.0), (2.0, 200.0)], "balls < all", "ms");
        assert!(svg.contains("points=\"240.0,157.0 434.0,46.0\""), "{svg}");
        assert_eq!(svg.matches("<circle").count(), 2);
        assert!(svg.contains("balls &lt; all"));
    }

    #[test]
    fn nothing_to_plot_is_an_empty_plot() {
        for points in [&[][..], &[(0.0, 0.0)]] {
            assert!(!line_plot(points, "x", "y").contains("NaN"));
        }
    }
}
