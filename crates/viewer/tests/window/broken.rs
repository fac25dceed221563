//! What cannot be read, what takes long, and what is given up.

use std::sync::Arc;
use std::sync::Mutex;
use std::sync::mpsc::{Receiver, channel};
use std::time::{Duration, Instant};

use egui_kittest::kittest::Queryable;
use metaball::{BoxError, ReadOptions};
use viewer::{Opener, Progress, Subject};

use crate::stage::{Bench, start, until, until_sharp, window, window_of};

#[test]
fn a_broken_file_is_an_error_that_is_read_and_the_next_file_opens() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("pool.csv");
    std::fs::write(&path, "x,y,z,radius\n0,0,0,four\n").expect("written");
    let mut harness = window(&path.display().to_string());
    until(&mut harness, |viewer| viewer.failure().is_some());
    harness.step();
    harness.get_by_label_contains("line 2, column 4 (radius): needed a finite number");
    assert!(harness.state().viewer().painting().is_none());

    std::fs::write(&path, "x,y,z,radius\n0,0,0,4\n").expect("written");
    let field = harness.get_by_label("Open");
    field.focus();
    harness.step();
    harness.get_by_label("Open").type_text(&path.display().to_string());
    harness.step();
    harness.get_by_label("Go").click();
    until_sharp(&mut harness);
    let viewer = harness.state().viewer();
    assert_eq!(viewer.failure(), None);
    assert_eq!(viewer.model().expect("built").scene().len(), 1);
    let notes = viewer.subject().expect("open").notes.as_ref().expect("of a file");
    let first = notes.iter().next().expect("a note").text.clone();
    harness.get_by_label(&first);
}

/// What was there before is still there, with all that was asked of it.
#[test]
fn a_build_can_be_given_up_and_a_failed_opening_changes_nothing() {
    let mut begin = start("two-merging");
    begin.field.threshold = Some(0.3);
    let mut harness = window_of(Arc::new(Bench), begin);
    until_sharp(&mut harness);
    let before = harness.state().viewer().command_line().expect("open");
    harness.state_mut().viewer_mut().open("nowhere.xyz".to_owned());
    until(&mut harness, |viewer| viewer.failure().is_some());
    assert_eq!(harness.state().viewer().command_line().expect("open"), before);

    harness.state_mut().viewer_mut().open("scattered:200000".to_owned());
    until(&mut harness, |viewer| matches!(viewer.progress(), Progress::Building(_)));
    assert_ne!(harness.state().viewer().command_line().expect("open"), before);
    harness.state_mut().viewer_mut().cancel();
    assert_eq!(harness.state().viewer().command_line().expect("open"), before);
    std::thread::sleep(Duration::from_millis(1500));
    harness.step();
    until_sharp(&mut harness);
    let viewer = harness.state().viewer();
    assert_eq!(viewer.model().expect("built").scene().len(), 2);
    assert_eq!(viewer.subject().expect("open").spec, "two-merging");
}

/// Opens when it is told to.
struct Slow(Mutex<Receiver<()>>);

impl Opener for Slow {
    fn open(&self, spec: &str, reading: &ReadOptions) -> Result<Subject, BoxError> {
        let _ = self.0.lock().expect("no panic").recv();
        Bench.open(spec, reading)
    }
}

#[test]
fn reading_can_be_given_up_and_closing_does_not_wait_for_it() {
    let (go, told) = channel();
    let mut harness = window_of(Arc::new(Slow(Mutex::new(told))), start("two-merging"));
    std::thread::sleep(Duration::from_millis(300));
    harness.step();
    harness.step();
    assert!(matches!(harness.state().viewer().progress(), Progress::Reading(_)));
    harness.get_by_label("Cancel").click();
    harness.step();
    assert_eq!(harness.state().viewer().progress(), Progress::Ready);
    go.send(()).expect("it waits");
    std::thread::sleep(Duration::from_millis(200));
    harness.step();
    assert!(harness.state().viewer().subject().is_none(), "nobody wants it any more");

    let mut harness = window("scattered:200000");
    until(&mut harness, |viewer| matches!(viewer.progress(), Progress::Building(_)));
    let begin = Instant::now();
    drop(harness);
    assert!(begin.elapsed() < Duration::from_secs(1));
}
