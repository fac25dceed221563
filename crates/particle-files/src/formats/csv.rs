//! Tables: rows of fields, mostly below a line of names.
//!
//! Commas, semicolons, tabs or blanks stand between fields. Lines before the names that start with `#`,
//! `%` or `//` are comments, but the last of them has the names where it names coordinates. Without
//! names the first three columns are x, y and z.

mod top;
mod units;

use super::{Reader, Request, Span, Wanted};
use crate::error::Flaw;
use crate::notes::{Notes, counted};
use crate::number::{DecimalMark, number};
use crate::roles::{Role, plain};
use crate::rows::{Becomes, Field, Rows, Separator, Width};
use crate::table::Table;
use top::{Header, Top, axis_of, begins_with_numbers, columns, sample};

pub(super) const READER: Reader = Reader {
    name: "CSV",
    endings: &["csv", "tsv", "txt", "dat"],
    is_text: true,
    recognizes,
    frames: |bytes| Ok(vec![Span::whole(bytes)]),
    table,
};

/// Bytes that start a comment.
const COMMENT: &[u8] = b"#%";

/// Whether the first line that is no comment has at least three fields, names or numbers, or a later one
/// names coordinates.
fn recognizes(bytes: &[u8]) -> bool {
    let top = Top::of(bytes);
    let Some((_, line)) = top.first else { return false };
    let columns = columns(line, top.separator());
    let has_axis = || columns.iter().take(1000).any(|name| axis_of(name).is_some());
    let names_axis = || columns.len() >= 3 && has_axis();
    begins_with_numbers(&columns) || names_axis() || top.named_by_comment().is_some()
}

/// Reads a table.
fn table(bytes: &[u8], _: &Span, request: &Request, notes: &mut Notes) -> Result<Table, Flaw> {
    let top = Top::of(bytes);
    let Header { names, line, first_row, separator } = top.header(bytes, request, notes)?;
    let rows_at = offset_of(bytes, first_row);
    let sample = sample(&bytes[rows_at..], separator);
    let mark = decimal_mark(separator, &sample);
    let mut fields = fields(&names, &sample, mark, request).map_err(|flaw| flaw.at_line(line))?;
    // A name behind the last separator is no column.
    if fields.len() > 3 && names.last().is_some_and(String::is_empty) {
        fields.pop();
    }
    let mut rows = Rows { separator, mark, fields, width: Width::Exactly, skips: Some(COMMENT) };
    let mut table = read_rows(&mut rows, &bytes[rows_at..], first_row)?;
    units::of_coordinates(&names, &mut table, notes);
    say_times(&names, &bytes[rows_at..], separator, notes);
    let between = match separator {
        Separator::Byte(b',') => "commas",
        Separator::Byte(b';') => "semicolons",
        Separator::Byte(_) => "tabs",
        Separator::Blanks => "blanks",
    };
    let comma = if rows.mark == DecimalMark::Comma { ", decimal commas" } else { "" };
    notes.read(format!("{} between {} in a row{comma}", between, counted(names.len(), "field")));
    let ignored = rows.fields.iter().filter(|field| field.becomes == Becomes::Nothing);
    let ignored: Vec<&str> =
        ignored.map(|field| field.name.as_str()).filter(|name| !name.is_empty()).collect();
    if !ignored.is_empty() {
        notes.left_out(format!("columns not used: {}", ignored.join(", ")));
    }
    Ok(table)
}

/// The rows; what looked like numbers may turn out to be words, or to have decimal commas, further down.
fn read_rows(rows: &mut Rows, bytes: &[u8], first_row: usize) -> Result<Table, Flaw> {
    loop {
        match rows.read(bytes, first_row) {
            Err(flaw) if becomes_words(rows, &flaw) => {}
            Err(flaw) if rows.mark == DecimalMark::Point && has_own_commas(rows, &flaw) => {
                let with_commas = Rows { mark: DecimalMark::Comma, ..rows.clone() };
                let table = with_commas.read(bytes, first_row).map_err(|_| flaw)?;
                *rows = with_commas;
                return Ok(table);
            }
            read => return read,
        }
    }
}

/// Says that particles of several times are drawn together, where the first and the last row differ.
fn say_times(names: &[String], rows: &[u8], separator: Separator, notes: &mut Notes) {
    const TIMES: [&str; 6] = ["time", "t", "step", "timestep", "time step", "frame"];
    let is_time = |name: &String| TIMES.contains(&plain(name).as_str());
    let Some(index) = names.iter().position(is_time) else { return };
    let end = rows.trim_ascii_end();
    let begin = memchr::memrchr(b'\n', end).map_or(0, |end| end + 1);
    let first = sample(rows, separator).into_iter().nth(index).unwrap_or_default();
    let last = columns(&end[begin..], separator).into_iter().nth(index).unwrap_or_default();
    if first != last {
        let name = &names[index];
        notes.guessed(format!(
            "{name:?} goes from {first} to {last}: particles of all times are drawn together (--keep \
             {name}={first} draws those of one)"
        ));
    }
}

/// Whether a flaw may be of a decimal comma: of a number where commas stand in fields only.
fn has_own_commas(rows: &Rows, flaw: &Flaw) -> bool {
    rows.separator != Separator::Byte(b',') && flaw.location.column.is_some()
}

/// Whether the numbers of a row have a decimal comma.
fn decimal_mark(separator: Separator, sample: &[String]) -> DecimalMark {
    let is_comma = |field: &String| {
        field.contains(',') && number(field.as_bytes(), DecimalMark::Comma).is_some()
    };
    if separator != Separator::Byte(b',') && sample.iter().any(is_comma) {
        DecimalMark::Comma
    } else {
        DecimalMark::Point
    }
}

fn fields(
    names: &[String],
    sample: &[String],
    mark: DecimalMark,
    request: &Request,
) -> Result<Vec<Field>, Flaw> {
    let mut seen = [false; 3];
    let mut fields: Vec<Field> = Vec::with_capacity(names.len());
    let names = with_colors(names);
    let roles: Vec<Option<Role>> = names.iter().map(|name| role_of(name, &names)).collect();
    for (index, (name, role)) in names.iter().zip(roles.iter().copied()).enumerate() {
        if role.is_some_and(Role::makes_balls) && roles[..index].contains(&role) {
            let flaw = Flaw::needed("each column once", format_args!("{name:?} again"));
            return Err(flaw.at_column(index + 1));
        }
        let sampled = sample.get(index).map_or(b"0".as_slice(), |field| field.as_bytes());
        // The other coordinates of a table with two triples of them are columns like any.
        let wanted = match &request.wanted {
            Wanted::Named(names) if role.is_none() && Role::of(name).is_some() => {
                names.iter().any(|named| named.eq_ignore_ascii_case(name))
            }
            wanted => !name.is_empty() && wanted.wants(name),
        };
        let becomes = match role.and_then(Role::axis) {
            Some(axis) => {
                seen[axis] = true;
                Becomes::Coordinate(axis)
            }
            None if !wanted => Becomes::Nothing,
            None if role.is_some_and(Role::is_word) => Becomes::Word,
            None if role.is_some() => Becomes::Number,
            None if sampled.is_empty() || number(sampled, mark).is_some() => Becomes::Number,
            None => Becomes::Word,
        };
        fields.push(Field { name: name.clone(), becomes });
    }
    if let Some(missing) = seen.iter().position(|seen| !seen) {
        let axis = ["x", "y", "z"][missing];
        let needed = format!("a column {axis:?} in the line of names");
        let found: String = names.join(",").chars().take(200).collect();
        let flaw = Flaw::needed(&needed, format_args!("{found:?}"));
        let flaw = flaw.or("name the columns with --columns, in their order");
        return Err(match seen {
            [true, true, false] => flaw.or("points of a plane need a column z of zeros"),
            _ => flaw,
        });
    }
    Ok(fields)
}

/// The role of a column among others: of several for an axis, such as `x` and `center_x`, the plainest
/// says where a particle is.
fn role_of(name: &str, names: &[String]) -> Option<Role> {
    let role = Role::of(name)?;
    let plainness = |name: &str| {
        let plain = plain(name);
        match plain.len() {
            1 => 0,
            _ if ["pos", "coord", "point"].iter().any(|place| plain.contains(place)) => 1,
            _ => 2,
        }
    };
    let is_plainer =
        |other: &String| Role::of(other) == Some(role) && plainness(other) < plainness(name);
    (role.axis().is_none() || !names.iter().any(is_plainer)).then_some(role)
}

/// The names, where `r`, `g` and `b` are all there as red, green and blue: `r` alone is a radius.
fn with_colors(names: &[String]) -> Vec<String> {
    const COLORS: [&str; 3] = ["red", "green", "blue"];
    let is_one = |letter: &&str| names.iter().filter(|name| bare(name) == *letter).count() == 1;
    let letters = [["r", "g", "b"], ["R", "G", "B"]];
    let Some(letters) = letters.into_iter().find(|letters| letters.iter().all(is_one)) else {
        return names.to_vec();
    };
    let color = |name: &String| {
        let index = letters.iter().position(|letter| *letter == bare(name));
        index.map_or_else(|| name.clone(), |index| COLORS[index].to_owned())
    };
    names.iter().map(color).collect()
}

/// A name without quotes.
fn bare(name: &str) -> &str {
    name.trim_matches(|c: char| c == '"' || c == '\'' || c.is_whitespace())
}

/// Whether the flaw is of a column that only looked like one of numbers, and is one of words from now on.
fn becomes_words(rows: &mut Rows, flaw: &Flaw) -> bool {
    let Some(column) = flaw.location.column else { return false };
    let Some(field) = rows.fields.get_mut(column - 1) else { return false };
    if field.becomes == Becomes::Number && Role::of(&field.name).is_none() {
        field.becomes = Becomes::Word;
        return true;
    }
    false
}

/// Whether a line has no row.
fn is_comment(line: &[u8]) -> bool {
    line.trim_ascii_start().first().is_none_or(|byte| COMMENT.contains(byte))
}

/// Where a line begins.
fn offset_of(bytes: &[u8], line: usize) -> usize {
    let ends = memchr::memchr_iter(b'\n', bytes);
    if line == 1 { 0 } else { ends.map(|end| end + 1).nth(line - 2).unwrap_or(bytes.len()) }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;
    use proptest::prelude::*;

    use super::*;
    use crate::formats::testing::words;
    use crate::table::{Lines, Values};
    use crate::units::Unit;

    fn read(text: &str) -> Result<Table, Flaw> {
        let request = Request { wanted: Wanted::Named(vec!["mass".into()]), ..Request::default() };
        table(text.as_bytes(), &Span::whole(b""), &request, &mut Notes::default())
    }

    fn refusal(text: &str) -> String {
        read(text).expect_err("refused").in_file("balls.csv").to_string()
    }

    #[test]
    fn columns_come_in_any_order() {
        let text = "blue, radius,x,y,z,green,red,Strength\n1, 2,3,4,5,0.5,0,6\n";
        let table = read(text).expect("legal");
        assert_eq!(table.positions, [DVec3::new(3.0, 4.0, 5.0)]);
        assert_eq!(
            (words(&table, "radius"), words(&table, "strength")),
            (vec!["2".into()], vec!["6".into()])
        );
        assert_eq!(table.lines, Lines::From(2));
    }

    /// Each is the same two particles.
    #[test]
    fn tables_of_all_programs_are_read() {
        for text in [
            "x,y,z\n1.5,2,3\n-4,5,6\n",
            "x;y;z\r\n1,5;2;3\r\n-4;5;6\r\n",
            "x;y;z\n1.5;2;3\n-4;5;6\n",
            "x\ty\tz\n1,5\t2\t3\n-4\t5\t6\n",
            "x y z\n1.5 2 3\n -4  5\t6\n",
            "1.5 2 3\n-4 5 6\n",
            "1,5 2,0 3,0\n-4,0 5,0 6,0\n",
            "1.5, 2, 3\n-4, 5, 6",
            "# x y z\n1.5 2 3\n-4 5 6\n",
            "# made by hand\n# x, y, z\n1.5,2,3\n\n# no particle\n-4,5,6\n",
            "// a comment\nX, Y, Z,\n1.5, 2, 3,\n-4, 5, 6,\n",
            "\"Points:0\",\"Points:1\",\"Points:2\",\"Velocity:0\"\n1.5,2,3,9\n-4,5,6,9\n",
            "Pos.x [m];Pos.y [m];Pos.z [m];Idp\n1.5;2;3;0\n-4;5;6;1\n",
            ",x,y,z\n0,1.5,2,3\n1,-4,5,6\n",
            "id,x,y,z,what\n1,1.5D0,2,3,fluid\n2,-4,5,6.0e0,\"a, b\"\n",
            "what x y z\n1 1.5 2 3\nb -4 5 6\n",
            "\"x\",\"y\",\"z\"\n\"1\",1.5,2,3\n\"2\",-4,5,6\n",
            "\"x\" \"y\" \"z\"\n\"1\" 1.5 2 3\n\"2\" -4 5 6\n",
            "sep=;\nx;y;z\n1,5;2;3\n-4;5;6\n",
            "Exported by hand\n,,\nx,y,z\n1.5,2,3\n-4,5,6\n",
            "x,y,z\nm,m,m\n1.5,2,3\n-4,5,6\n",
            ",0,1,2\n0,1.5,2,3\n1,-4,5,6\n",
            "0,1,2\n1.5,2,3\n-4,5,6\n",
            "z;y;x\n3;2;1,5\n6;5;-4\n",
            "center_x,x,y,z\n9,1.5,2,3\n9,-4,5,6\n",
        ] {
            let table = read(text).unwrap_or_else(|flaw| panic!("{text}: {flaw:?}"));
            let expected = [DVec3::new(1.5, 2.0, 3.0), DVec3::new(-4.0, 5.0, 6.0)];
            assert_eq!(table.positions, expected, "{text}");
            assert!(recognizes(text.as_bytes()), "{text}");
        }
    }

    #[test]
    fn commas_of_numbers_show_further_down() {
        let table = read("x;y;z;mass\n1;2;3;4\n1,5;2;3;4,5\n").expect("legal");
        assert_eq!(table.positions[1].x, 1.5);
        assert_eq!(words(&table, "mass"), ["4", "4.5"]);
        assert!(refusal("x;y;z\n1;2;3\n1,5;2.5;3\n").contains("line 3, column 1 (x)"));
    }

    #[test]
    fn three_letters_are_colors() {
        let table = read("x,y,z,r,g,b\n1,2,3,0,128,255\n").expect("legal");
        assert!(table.column("r").is_none());
        let colors = ["red", "green", "blue"].map(|name| words(&table, name).remove(0));
        assert_eq!(colors, ["0", "128", "255"]);
        let table = read("x,y,z,radius,r,g,b\n1,2,3,4,0,128,255\n").expect("legal");
        assert_eq!(words(&table, "radius"), ["4"]);
        let table = read("x,y,z,R,r,g,b\n1,2,3,4,0,128,255\n").expect("legal");
        assert_eq!(
            (words(&table, "R"), words(&table, "red")),
            (vec!["4".into()], vec!["0".into()])
        );
        assert_eq!(words(&read("x,y,z,r,g\n1,2,3,4,5\n").expect("legal"), "r"), ["4"]);
    }

    #[test]
    fn sizes_have_the_unit_of_the_coordinates() {
        let radius = |text: &str| words(&read(text).expect("legal"), "radius [mm]");
        assert_eq!(radius("x [m],y [m],z [m],radius [mm]\n1,2,3,500\n"), ["0.5"]);
        assert_eq!(radius("x [mm],y [mm],z [mm],radius [mm]\n1,2,3,500\n"), ["500"]);
        assert_eq!(radius("x,y,z,radius\nm,m,m,mm\n1,2,3,500\n"), ["0.5"]);
        assert_eq!(radius("x,y,z,radius [mm]\n1,2,3,500\n"), ["500"]);
    }

    #[test]
    fn what_is_guessed_of_the_first_lines_is_said() {
        let said = |text: &str| {
            let mut notes = Notes::default();
            let request = Request::default();
            table(text.as_bytes(), &Span::whole(b""), &request, &mut notes).expect("legal");
            notes.iter().map(|note| note.text.clone()).collect::<Vec<_>>().join("\n")
        };
        assert!(said("title\nx,y,z\n1,2,3\n").contains("1 line before the names"));
        assert!(said(",0,1,2\n0,1.5,2,3\n").contains("counts the columns"));
        assert!(said("0,1,2\n3,4,5\n").contains("no line of names"));
        assert!(said("x,y,z\nm,m,m\n1,2,3\n").contains("units in line 2"));
        let times = "time,x,y,z\n0,1,2,3\n0.5,1,2,3\n";
        assert!(said(times).contains("\"time\" goes from 0 to 0.5"));
        assert!(!said("time,x,y,z\n0,1,2,3\n0,1,2,3\n").contains("goes from"));
    }

    #[test]
    fn the_plainest_of_several_coordinates_counts() {
        for (names, x) in [
            ("com_x,com_y,com_z,x,y,z", 4.0),
            ("p_x,p_y,p_z,pos_x,pos_y,pos_z", 4.0),
            ("x,y,z,position_x,position_y,position_z", 1.0),
        ] {
            let table = read(&format!("{names}\n1,2,3,4,5,6\n")).expect("legal");
            assert_eq!((table.positions[0].x, table.columns.len()), (x, 0), "{names}");
        }
    }

    #[test]
    fn names_say_the_unit() {
        let unit = |name: &str| read(&format!("x{name},y,z\n1,2,3\n")).expect("legal").unit;
        assert_eq!(unit(" [nm]"), Some(Unit::Nanometre));
        assert_eq!(unit(" (Å)"), Some(Unit::Angstrom));
        assert_eq!((unit(" [mm]"), unit("")), (None, None));
    }

    #[test]
    fn names_can_be_given() {
        let read = |text: &str| {
            let names = ["x", "mass", "y", "z"].map(str::to_owned).to_vec();
            let request = Request { names: Some(names), ..Request::default() };
            table(text.as_bytes(), &Span::whole(b""), &request, &mut Notes::default())
        };
        for text in ["1,2,3,4\n", "a,b,c,d\n1,2,3,4\n"] {
            let table = read(text).expect("legal");
            assert_eq!(table.positions, [DVec3::new(1.0, 3.0, 4.0)]);
            assert_eq!(words(&table, "mass"), ["2"]);
        }
        assert!(read("1,2,3\n").is_err());
    }

    #[test]
    fn only_wanted_columns_are_kept() {
        let table = read("x,y,z,mass,other\n1,2,3,4,5\n").expect("legal");
        assert_eq!((table.columns.len(), words(&table, "mass")), (1, vec!["4".into()]));
    }

    #[test]
    fn no_rows_are_no_balls() {
        assert_eq!(read("x,y,z,radius\n").expect("legal").len(), 0);
    }

    #[test]
    fn refusals_name_line_and_column() {
        assert_eq!(
            refusal("x,y,z,radius\n1,2,3,4\n1,2,3,four\n"),
            "balls.csv, line 3, column 4 (radius): needed a finite number, found \"four\""
        );
        assert_eq!(
            refusal("x,y,radius\n"),
            "balls.csv, line 1: needed a column \"z\" in the line of names, found \"x,y,radius\"; name \
             the columns with --columns, in their order; points of a plane need a column z of zeros"
        );
        assert_eq!(
            refusal("x,y,z,radius\n\n1,2,3\n"),
            "balls.csv, line 3: needed 4 fields as in the first line, found 3"
        );
        assert!(refusal("x,x\n").contains("needed each column once, found \"x\" again"));
        assert!(refusal("x,y,z\n\"0,5\",\"0,1\",\"1,0\"\n").contains("decimal comma"));
        assert!(refusal("x,y,z\n1,nan,1\n").contains("found \"nan\""));
        assert!(refusal("").contains("needed a line of names"));
        assert!(refusal(&"a,".repeat(200_000)).contains("line 1: needed at most 100000 fields"));
    }

    proptest! {
        #[test]
        fn no_bytes_panic(bytes in any::<Vec<u8>>()) {
            recognizes(&bytes);
            let _ = table(&bytes, &Span::whole(&bytes), &Request::default(), &mut Notes::default());
        }

        #[test]
        fn no_rows_panic(rows in "x[,;]y[,; ]z[,;]radius([,;]strength)?(,red,green,blue)?\n([-0-9.e,;\"\n]{0,40})") {
            let _ = read(&rows);
        }

        /// What a table says is what is read: f64 numbers print so that they read back exactly.
        #[test]
        fn tables_read_back(balls in prop::collection::vec(prop::array::uniform4(-1e6f64..1e6), 0..20)) {
            let rows: Vec<String> =
                balls.iter().map(|[x, y, z, radius]| format!("{radius},{x},{y},{z}\n")).collect();
            let table = read(&format!("radius,x,y,z\n{}", rows.concat())).expect("legal");
            let expected: Vec<_> = balls.iter().map(|&[x, y, z, _]| DVec3::new(x, y, z)).collect();
            prop_assert_eq!(table.positions, expected);
            let radii = Values::Numbers(balls.iter().map(|ball| ball[3]).collect());
            prop_assert_eq!(table.columns[0].values.clone(), radii);
        }
    }
}
