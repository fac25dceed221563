//! What a page is put together with.

/// Replaces each `{{name}}` of the template once, without looking into what was put in.
pub fn fill(template: &str, parts: &[(&str, String)]) -> String {
    let mut page = String::new();
    let mut rest = template;
    while let Some((before, after)) = rest.split_once("{{") {
        let (name, after) = after.split_once("}}").unwrap_or((after, ""));
        page.push_str(before);
        if let Some((_, text)) = parts.iter().find(|(part, _)| *part == name) {
            page.push_str(text);
        }
        rest = after;
    }
    page + rest
}

/// A table under a title; headings and rows are HTML.
pub fn section(title: &str, headings: &str, rows: &str) -> String {
    format!(
        "<section>\n<h2>{}</h2>\n<div class=\"scroll\"><table><thead><tr>{headings}</tr></thead>\n\
         <tbody>\n{rows}</tbody></table></div>\n</section>\n",
        escape(title)
    )
}

/// A table of plain text under a title. The columns `text` are set left, all others right. A row that is
/// too short ends with a reason, which takes the place of all that is not there. A rule parts rows
/// whose first cells differ.
pub fn table(title: &str, headings: &[&str], text: &[usize], rows: &[Vec<String>]) -> String {
    let class = |column: usize| if text.contains(&column) { " class=\"text\"" } else { "" };
    let heading =
        |(column, name): (usize, &&str)| format!("<th{}>{}</th>", class(column), escape(name));
    let row = |(place, cells): (usize, &Vec<String>)| {
        let missing = headings.len().saturating_sub(cells.len());
        let cell = |(column, text): (usize, &String)| {
            let text = escape(text);
            if missing > 0 && column + 1 == cells.len() {
                format!("<td class=\"reason\" colspan=\"{}\">{text}</td>", missing + 1)
            } else {
                format!("<td{}>{text}</td>", class(column))
            }
        };
        let continues = place > 0 && rows[place - 1].first() == cells.first();
        let first = if continues { "" } else { " class=\"first\"" };
        format!("<tr{first}>{}</tr>\n", cells.iter().enumerate().map(cell).collect::<String>())
    };
    let body: String = rows.iter().enumerate().map(row).collect();
    section(title, &headings.iter().enumerate().map(heading).collect::<String>(), &body)
}

/// Text as HTML shows it, also between quotation marks.
pub fn escape(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for character in text.chars() {
        match character {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '"' => escaped.push_str("&quot;"),
            '\'' => escaped.push_str("&#39;"),
            other => escaped.push(other),
        }
    }
    escaped
}

/// Bytes as base64 of RFC 4648, section 4, for `data:` addresses.
pub fn base64(bytes: &[u8]) -> String {
    const ALPHABET: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::with_capacity(bytes.len().div_ceil(3) * 4);
    for chunk in bytes.chunks(3) {
        let byte = |index: usize| u32::from(chunk.get(index).copied().unwrap_or(0));
        let group = byte(0) << 16 | byte(1) << 8 | byte(2);
        for place in 0..4 {
            let letter = ALPHABET[(group >> (18 - 6 * place)) as usize & 63];
            text.push(if place <= chunk.len() { char::from(letter) } else { '=' });
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn html_is_escaped() {
        assert_eq!(
            escape("<a href='x'>\"&\"</a>"),
            "&lt;a href=&#39;x&#39;&gt;&quot;&amp;&quot;&lt;/a&gt;"
        );
        assert_eq!(escape("r²/R² ≤ 1"), "r²/R² ≤ 1");
    }

    #[test]
    fn tables_say_what_is_not_there() {
        let rows = [
            vec!["a".to_owned(), "1".to_owned(), "2".to_owned()],
            vec!["a".to_owned(), "too <large>".to_owned()],
            vec!["b".to_owned(), "3".to_owned(), "4".to_owned()],
        ];
        let html = table("T", &["scene", "ms", "n"], &[0], &rows);
        assert!(html.contains("<th class=\"text\">scene</th><th>ms</th>"), "{html}");
        let reason =
            "<tr><td class=\"text\">a</td><td class=\"reason\" colspan=\"2\">too &lt;large&gt;";
        assert!(html.contains(reason), "{html}");
        assert_eq!(html.matches("class=\"first\"").count(), 2, "a, and b");
    }

    #[test]
    fn base64_is_that_of_the_rfc() {
        let vectors = [
            ("", ""),
            ("f", "Zg=="),
            ("fo", "Zm8="),
            ("foo", "Zm9v"),
            ("foob", "Zm9vYg=="),
            ("fooba", "Zm9vYmE="),
            ("foobar", "Zm9vYmFy"),
        ];
        for (plain, encoded) in vectors {
            assert_eq!(base64(plain.as_bytes()), encoded);
        }
        assert_eq!(base64(&[0xfb, 0xff]), "+/8=");
    }

    #[test]
    fn templates_are_filled_once() {
        let parts = [("a", "{{b}}".to_owned()), ("b", "B".to_owned())];
        assert_eq!(fill("x {{a}} y {{b}} z", &parts), "x {{b}} y B z");
    }
}
