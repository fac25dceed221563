//! The little of JSON that cargo and criterion write: values after a key, in JSON without spaces. A key
//! inside of a string would have its quotes escaped, so none is found there.

/// The first string after a key.
pub(super) fn string(json: &str, key: &str) -> Option<String> {
    let mut text = String::new();
    let mut characters = after(json, key)?.strip_prefix('"')?.chars();
    loop {
        match characters.next()? {
            '"' => return Some(text),
            '\\' => text.push(escaped(&mut characters)?),
            character => text.push(character),
        }
    }
}

fn escaped(characters: &mut std::str::Chars<'_>) -> Option<char> {
    match characters.next()? {
        'n' => Some('\n'),
        't' => Some('\t'),
        'u' => {
            let digits: String = characters.take(4).collect();
            char::from_u32(u32::from_str_radix(&digits, 16).ok()?)
        }
        character @ ('"' | '\\' | '/') => Some(character),
        _ => None,
    }
}

/// The first list of numbers after a key.
pub(super) fn numbers(json: &str, key: &str) -> Option<Vec<f64>> {
    let (list, _) = after(json, key)?.strip_prefix('[')?.split_once(']')?;
    if list.trim().is_empty() {
        return Some(Vec::new());
    }
    list.split(',').map(|number| number.trim().parse().ok()).collect()
}

fn after<'a>(json: &'a str, key: &str) -> Option<&'a str> {
    Some(json.split_once(&format!("\"{key}\":"))?.1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_found_by_their_keys() {
        let json = r#"{"a":"say \"b\":[9]","path":"C:\\x\u0041","b":[1.0,2.5e3],"c":[],"d":["e"]}"#;
        assert_eq!(string(json, "a").as_deref(), Some("say \"b\":[9]"));
        assert_eq!(string(json, "path").as_deref(), Some("C:\\xA"));
        assert_eq!(numbers(json, "b"), Some(vec![1.0, 2500.0]));
        assert_eq!(numbers(json, "c"), Some(Vec::new()));
        assert_eq!((numbers(json, "d"), numbers(json, "a"), string(json, "b")), (None, None, None));
        assert_eq!(string(r#"{"a":"unended"#, "a"), None);
    }
}
