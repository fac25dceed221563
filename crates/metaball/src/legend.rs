//! Legends of colours, as pictures of their own.

use std::fmt::Write;
use std::path::Path;

use metaball_core::Color;
use particle_files::{Legend, Scale};
use picture_files::write_atomically;

use crate::Error;

/// The height of a line, and the width of all, in pixels.
const LINE: usize = 22;
const WIDTH: usize = 260;

/// The steps of a colour map that are drawn.
const STEPS: usize = 64;

/// A legend as SVG: a bar from the least value to the greatest, or a square for each word.
pub fn legend_svg(legend: &Legend) -> String {
    let (body, lines) = match &legend.scale {
        Scale::Numbers(from, to) => (bar(*from, *to), 3),
        Scale::Words(words) => (squares(words), words.len() + 1),
    };
    let height = LINE * lines + LINE / 2;
    let title = escaped(&legend.title);
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{WIDTH}\" height=\"{height}\" \
         font-family=\"sans-serif\" font-size=\"14\">\n\
         <rect width=\"{WIDTH}\" height=\"{height}\" fill=\"white\"/>\n\
         <text x=\"10\" y=\"17\" font-weight=\"bold\">{title}</text>\n{body}</svg>\n"
    )
}

/// Writes it to a file, whole or not at all.
///
/// # Errors
/// When the file cannot be written.
pub fn save_legend(legend: &Legend, path: &Path) -> Result<(), Error> {
    Ok(write_atomically(path, legend_svg(legend).as_bytes())?)
}

fn bar(from: f64, to: f64) -> String {
    let width = (WIDTH - 20) as f64 / STEPS as f64;
    let mut svg = String::new();
    for step in 0..STEPS {
        let x = 10.0 + width * step as f64;
        let color = Legend::color_at((step as f64 + 0.5) / STEPS as f64);
        // A little wider, so that no seam shows between steps.
        let wide = if step + 1 < STEPS { width + 0.5 } else { width };
        let fill = hex(color);
        let _ = writeln!(
            svg,
            "<rect x=\"{x}\" y=\"{LINE}\" width=\"{wide}\" height=\"{LINE}\" fill=\"{fill}\"/>"
        );
    }
    let (low, right) = (3 * LINE - 5, WIDTH - 10);
    let _ = writeln!(svg, "<text x=\"10\" y=\"{low}\">{from}</text>");
    let _ = writeln!(svg, "<text x=\"{right}\" y=\"{low}\" text-anchor=\"end\">{to}</text>");
    svg
}

fn squares(words: &[(String, Color)]) -> String {
    let mut svg = String::new();
    for (line, (word, color)) in words.iter().enumerate() {
        let (top, text) = (LINE * (line + 1) + 3, LINE * (line + 2) - 6);
        let (fill, word) = (hex(*color), escaped(word));
        let _ = writeln!(
            svg,
            "<rect x=\"10\" y=\"{top}\" width=\"16\" height=\"16\" fill=\"{fill}\"/>\
             <text x=\"36\" y=\"{text}\">{word}</text>"
        );
    }
    svg
}

fn hex(color: Color) -> String {
    let [red, green, blue] = color.to_srgb();
    format!("#{red:02x}{green:02x}{blue:02x}")
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_a_bar_and_words_a_square_each() {
        let title = "a<b".to_owned();
        let numbers =
            legend_svg(&Legend { title: title.clone(), scale: Scale::Numbers(-1.5, 2.0) });
        assert_eq!(numbers.matches("<rect").count(), STEPS + 1);
        assert!(
            numbers.contains(">-1.5<") && numbers.contains(">2<") && numbers.contains("a&lt;b")
        );
        let red = ("O".to_owned(), Color::srgb(255, 13, 13));
        let words = legend_svg(&Legend { title, scale: Scale::Words(vec![red]) });
        assert!(words.contains("#ff0d0d") && words.contains(">O<"), "{words}");
    }
}
