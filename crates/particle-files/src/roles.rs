//! What a column says of particles, by its name.

/// What a column of a known name is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) enum Role {
    X,
    Y,
    Z,
    /// The support radius R.
    SupportRadius,
    /// The radius at which a particle alone shows.
    Radius,
    Diameter,
    Strength,
    Red,
    Green,
    Blue,
    /// An element's symbol or number, or a label that begins with it.
    Element,
    /// What an atom is called in its residue.
    Name,
    Residue,
    ResidueNumber,
    Chain,
    /// A type that a program gave a number or a name.
    Type,
    Charge,
    Mass,
    Density,
    SmoothingLength,
}

/// Names as [`plain`] has them.
const NAMES: &[(Role, &[&str])] = &[
    (Role::X, &["x", "posx", "xcoord"]),
    (Role::Y, &["y", "posy", "ycoord"]),
    (Role::Z, &["z", "posz", "zcoord"]),
    (Role::SupportRadius, &["support radius", "support"]),
    (Role::Radius, &["radius", "radii", "r", "rad", "particle radius", "pscale"]),
    (Role::Diameter, &["diameter", "d", "particle diameter"]),
    (Role::Strength, &["strength"]),
    (Role::Red, &["red", "cd 0", "color 0", "color r", "rgb 0"]),
    (Role::Green, &["green", "cd 1", "color 1", "color g", "rgb 1"]),
    (Role::Blue, &["blue", "cd 2", "color 2", "color b", "rgb 2"]),
    (
        Role::Element,
        &["element", "elements", "species", "symbol", "atom", "atomic number", "atomic numbers"],
    ),
    (Role::Name, &["name", "atom name"]),
    (Role::Residue, &["residue", "resname", "residue name"]),
    (Role::ResidueNumber, &["residue number", "resid", "resnum"]),
    (Role::Chain, &["chain", "chain id", "segment", "segid"]),
    (Role::Type, &["type", "types", "particle type", "atom type"]),
    (Role::Charge, &["charge", "charges", "q", "initial charges"]),
    (Role::Mass, &["mass", "masses", "m"]),
    (Role::Density, &["density", "rho", "rhop", "densities"]),
    (Role::SmoothingLength, &["smoothing length", "h", "hsml"]),
];

/// Words beside the letter or the number of an axis in the names of coordinates.
const PLACES: &[&str] = &[
    "atom",
    "center",
    "centre",
    "centroid",
    "com",
    "coord",
    "coordinate",
    "coordinates",
    "coords",
    "global",
    "loc",
    "location",
    "mass",
    "of",
    "p",
    "particle",
    "point",
    "points",
    "pos",
    "position",
    "positions",
    "r",
    "world",
];

/// Units behind a name without brackets.
const UNITS: &[&str] = &["m", "cm", "mm", "um", "µm", "μm", "nm", "km", "angstrom"];

impl Role {
    /// The role of a column of that name.
    pub(crate) fn of(name: &str) -> Option<Self> {
        let (plain, spaced) = (plain(name), plain(&with_blanks(name)));
        [plain.as_str(), spaced.as_str()].into_iter().find_map(|plain| {
            let of_plain = |plain| Self::of_plain(plain).or_else(|| Self::of_place(plain));
            let without_unit = || match plain.rsplit_once(' ') {
                Some((name, unit)) if UNITS.contains(&unit) => of_plain(name),
                _ => None,
            };
            of_plain(plain).or_else(without_unit)
        })
    }

    fn of_plain(plain: &str) -> Option<Self> {
        NAMES.iter().find(|(_, names)| names.contains(&plain)).map(|(role, _)| *role)
    }

    /// The axis of a name like `pos x`, `y position` or `points 2`.
    fn of_place(plain: &str) -> Option<Self> {
        let behind = plain.rsplit_once(' ').map(|(words, axis)| (axis, words));
        [behind, plain.split_once(' ')].into_iter().flatten().find_map(|(axis, words)| {
            let is_place = words.split(' ').all(|word| PLACES.contains(&word));
            let is_vector = words != "p" && words != "r";
            match axis {
                _ if !is_place => None,
                "x" => Some(Self::X),
                "y" => Some(Self::Y),
                "z" => Some(Self::Z),
                "0" if is_vector => Some(Self::X),
                "1" if is_vector => Some(Self::Y),
                "2" if is_vector => Some(Self::Z),
                _ => None,
            }
        })
    }

    /// The axis of a coordinate.
    pub(crate) fn axis(self) -> Option<usize> {
        match self {
            Self::X => Some(0),
            Self::Y => Some(1),
            Self::Z => Some(2),
            _ => None,
        }
    }

    /// Whether its values are words even where they look like numbers.
    pub(crate) fn is_word(self) -> bool {
        matches!(self, Self::Element | Self::Name | Self::Residue | Self::Chain | Self::Type)
    }

    /// Whether it says where, how large, of what colour or of which element a particle is.
    pub(crate) fn makes_balls(self) -> bool {
        !matches!(
            self,
            Self::ResidueNumber
                | Self::Charge
                | Self::Mass
                | Self::Density
                | Self::SmoothingLength
                | Self::Chain
        )
    }
}

/// A name with a blank before each capital behind a small letter.
fn with_blanks(name: &str) -> String {
    let mut spaced = String::with_capacity(name.len() + 4);
    let mut last = ' ';
    for c in name.chars() {
        if last.is_lowercase() && c.is_uppercase() {
            spaced.push(' ');
        }
        spaced.push(c);
        last = c;
    }
    spaced
}

/// A name without capitals and without a unit in brackets behind it; what is between its words is one
/// blank. `Pos.x [m]` and `POS_X` become `pos x`.
pub(crate) fn plain(name: &str) -> String {
    let name = name.trim_matches(|c: char| c == '"' || c == '\'' || c.is_whitespace());
    let name = match name.find(['[', '(', '{']) {
        Some(at) if at > 0 && !is_index(&name[at..]) => &name[..at],
        _ => name,
    };
    let lower = name.to_lowercase();
    let words = lower.split(|c: char| !c.is_alphanumeric()).filter(|word| !word.is_empty());
    words.collect::<Vec<_>>().join(" ")
}

/// Whether brackets hold a component's number, as in `pos[0]`, and no unit.
fn is_index(brackets: &str) -> bool {
    let inside = brackets[1..].trim_end_matches([']', ')', '}']);
    !inside.is_empty() && inside.bytes().all(|byte| byte.is_ascii_digit())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn programs_names_are_known() {
        for (name, role) in [
            ("Points:0", Role::X),
            ("Points_1", Role::Y),
            ("Pos.z [m]", Role::Z),
            (" \"X\" ", Role::X),
            ("y (mm)", Role::Y),
            ("support_radius", Role::SupportRadius),
            ("Support Radius", Role::SupportRadius),
            ("Rhop [kg/m^3]", Role::Density),
            ("atomic_number", Role::Element),
            ("r_x", Role::X),
            ("pos[1]", Role::Y),
            ("positionZ", Role::Z),
            ("CoordinateX", Role::X),
            ("x_coord", Role::X),
            ("Y Position", Role::Y),
            ("center_of_mass_z", Role::Z),
            ("x/m", Role::X),
            ("y_mm", Role::Y),
            ("radius_nm", Role::Radius),
            ("ParticleRadius", Role::Radius),
            ("pScale", Role::Radius),
            ("color:1", Role::Green),
        ] {
            assert_eq!(Role::of(name), Some(role), "{name}");
        }
        for name in
            ["Velocity:0", "Vel.x [m/s]", "", "xx", "Ace.x", "r 0", "velocityX", "of mass", "mx"]
        {
            assert_eq!(Role::of(name), None, "{name}");
        }
    }
}
