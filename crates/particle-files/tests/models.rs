//! Models, frames and parts of structures, as options choose them.

use particle_files::{LoadError, Particles, ReadOptions, Selection, Substance, parse};

const PDB: &str = "MODEL        2
ATOM      1  N   ALA A   1       0.000   0.000   0.000  1.00  0.00           N
ENDMDL
MODEL        4
ATOM      1  N   ALA A   1       0.000   0.000   9.000  1.00  0.00           N
ENDMDL
";

const CIF: &str = "data_x
loop_
_atom_site.type_symbol
_atom_site.Cartn_x
_atom_site.Cartn_y
_atom_site.Cartn_z
_atom_site.pdbx_PDB_model_num
N 0 0 0 2
N 0 0 9 4
";

fn read(text: &str, model: Option<i64>, frame: Option<u32>) -> Result<Particles, LoadError> {
    parse("a.file", text.as_bytes(), &ReadOptions { model, frame, ..ReadOptions::default() })
}

fn said(particles: &Particles) -> String {
    let notes: Vec<&str> = particles.notes.iter().map(|note| note.text.as_str()).collect();
    notes.join("; ")
}

#[test]
fn options_choose_one_of_several() {
    for text in [PDB, CIF] {
        let z = |model, frame| read(text, model, frame).expect("there").positions[0].z;
        assert_eq!((z(None, None), z(None, Some(1))), (0.0, 9.0));
        assert_eq!((z(Some(2), None), z(Some(4), None)), (0.0, 9.0));
    }
}

#[test]
fn what_is_left_out_is_said() {
    for text in [PDB, CIF] {
        let said = |model, frame| said(&read(text, model, frame).expect("there"));
        assert!(said(None, None).contains("1 frame after the first"));
        assert!(said(None, Some(1)).contains("frame 1 of 2, counted from 0"));
        let model = said(Some(4), None);
        assert!(model.contains("model 4; 1 other model") && !model.contains("frame"), "{model}");
    }
}

#[test]
fn what_is_not_there_is_refused() {
    for text in [PDB, CIF] {
        let refused = |model, frame| read(text, model, frame).expect_err("refused").to_string();
        assert!(refused(Some(1), None).contains("needed a model 1, found models 2, 4"));
        assert!(refused(None, Some(2)).contains("needed a number from 0 to 1, found 2"));
        let both = refused(Some(2), Some(0));
        assert_eq!(both, "model: needed a model or a frame, found both");
    }
    let table = read("x,y,z\n1,2,3\n", Some(1), None).expect_err("refused").to_string();
    assert!(table.starts_with("model 1: needed a file whose format has models"), "{table}");
}

#[test]
fn columns_choose_atoms() {
    let text = "ATOM      1  N   ALA A   1       0.000   0.000   0.000  1.00  5.00           N
HETATM    2  O   HOH B   2       1.000   0.000   0.000  1.00 50.00           O
HETATM    3 CA    CA C   3       2.000   0.000   0.000  1.00 20.00          CA2+
";
    let dropped = |rule: &str| {
        let drop = vec![rule.parse().expect("a rule")];
        let selection = Selection { drop, ..Selection::default() };
        let options = ReadOptions { selection, ..ReadOptions::default() };
        let left = parse("a.pdb", text.as_bytes(), &options).expect("legal").positions;
        left.iter().map(|position| position.x).collect::<Vec<_>>()
    };
    assert_eq!(dropped("water"), [0.0, 2.0]);
    assert_eq!(dropped("chain=C"), [0.0, 1.0]);
    assert_eq!(dropped("element=ca"), [0.0, 1.0]);
    assert_eq!(dropped("residue_number=2..3"), [0.0]);
    assert_eq!(dropped("b_factor=30.."), [0.0, 2.0]);
    assert_eq!(dropped("charge=2"), [0.0, 1.0]);
}

#[test]
fn ghost_atoms_are_left_out_of_molecules() {
    let text = "4\n\nO 0 0 0\nH 0.96 0 0\nBq 0.3 0.3 0.3\nH: 5 0 0\n";
    let molecule = parse("a.xyz", text.as_bytes(), &ReadOptions::default()).expect("legal");
    assert_eq!(molecule.len(), 2);
    assert!(said(&molecule).contains("2 ghost atoms (Bq"), "{}", said(&molecule));
    let all = ReadOptions { substance: Some(Substance::Particles), ..ReadOptions::default() };
    assert_eq!(parse("a.xyz", text.as_bytes(), &all).expect("legal").len(), 4);
    // Where others are no elements either, none is a ghost.
    let beads = text.replace("O ", "bead ");
    assert_eq!(parse("a.xyz", beads.as_bytes(), &ReadOptions::default()).expect("legal").len(), 4);
}
