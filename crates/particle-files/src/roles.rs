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
    (Role::X, &["x", "pos x", "position x", "points 0", "coordinates 0", "coord x", "p x", "posx"]),
    (Role::Y, &["y", "pos y", "position y", "points 1", "coordinates 1", "coord y", "p y", "posy"]),
    (Role::Z, &["z", "pos z", "position z", "points 2", "coordinates 2", "coord z", "p z", "posz"]),
    (Role::X, &["positions 0", "pos 0", "position 0", "x coordinate", "center x", "centre x"]),
    (Role::Y, &["positions 1", "pos 1", "position 1", "y coordinate", "center y", "centre y"]),
    (Role::Z, &["positions 2", "pos 2", "position 2", "z coordinate", "center z", "centre z"]),
    (Role::SupportRadius, &["support radius", "support"]),
    (Role::Radius, &["radius", "radii", "r", "rad", "particle radius", "pscale"]),
    (Role::Diameter, &["diameter", "d", "particle diameter"]),
    (Role::Strength, &["strength"]),
    (Role::Red, &["red", "cd 0"]),
    (Role::Green, &["green", "cd 1"]),
    (Role::Blue, &["blue", "cd 2"]),
    (
        Role::Element,
        &["element", "elements", "species", "symbol", "atomic number", "atomic numbers"],
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

impl Role {
    /// The role of a column of that name.
    pub(crate) fn of(name: &str) -> Option<Self> {
        let plain = plain(name);
        NAMES.iter().find(|(_, names)| names.contains(&plain.as_str())).map(|(role, _)| *role)
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

/// A name without capitals and without a unit in brackets behind it; what is between its words is one
/// blank. `Pos.x [m]` and `POS_X` become `pos x`.
pub(crate) fn plain(name: &str) -> String {
    let name = name.trim_matches(|c: char| c == '"' || c == '\'' || c.is_whitespace());
    let name = match name.find(['[', '(', '{']) {
        Some(at) if at > 0 => &name[..at],
        _ => name,
    };
    let lower = name.to_lowercase();
    let words = lower.split(|c: char| !c.is_alphanumeric()).filter(|word| !word.is_empty());
    words.collect::<Vec<_>>().join(" ")
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
        ] {
            assert_eq!(Role::of(name), Some(role), "{name}");
        }
        for name in ["Velocity:0", "Vel.x [m/s]", "", "xx", "Ace.x"] {
            assert_eq!(Role::of(name), None, "{name}");
        }
    }
}
