//! What a changed value costs the lab before the run takes it: `drag SCENE DRAGS`, both optional. Prints medians of the
//! work in the window and on the thread of the run, ms.

use lab::action::Action;
use lab::app_state::AppState;
use lab::session::branches::Branches;
use lab::session::runner::{RunEvent, RunRequest};
use std::path::Path;
use std::sync::Arc;
use std::time::Instant;

fn main() -> Result<(), String> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let name = words.first().map_or("figure-eight-seven", String::as_str);
    let drags = words.get(1).and_then(|word| word.parse().ok()).unwrap_or(200);
    let shipped = scene::shipped(name).ok_or("no such scene")?;
    let mut app_state = AppState::new();
    app_state.open(shipped.text.to_owned(), None, Path::new("scene.toml"))?;
    app_state.requests.clear();
    let scene = Arc::clone(app_state.scene().ok_or("no scene")?);
    let mut run = Branches::open(scene, |_| ()).map_err(|error| error.to_string())?;
    let simulation = run.list()[0].simulation();
    let (fleet, period) = (Arc::new(simulation.fleet().clone()), simulation.period());
    app_state.handle_event(RunEvent::Opened { fleet, period });
    let (mut window, mut thread) = (Vec::new(), Vec::new());
    for drag in 0..drags {
        let record = run.advance(0).ok_or("the run has ended")?.clone();
        app_state.handle_event(RunEvent::Records(0, vec![record]));
        let distance = 2.0 + 0.001 * f64::from(drag);
        let began = Instant::now();
        app_state.act(&Action::SetPoint { edge: 0, distance, bearing: 2.3 });
        window.push(began.elapsed().as_secs_f64());
        for request in std::mem::take(&mut app_state.requests) {
            if let RunRequest::Change(checked) = request {
                let began = Instant::now();
                let change = run.change(0, &checked)?;
                drop(checked);
                thread.push(began.elapsed().as_secs_f64());
                app_state.handle_event(RunEvent::Changed(0, change.ok_or("nothing has changed")?));
            }
        }
    }
    let whole: Vec<f64> = window.iter().zip(&thread).map(|(window, thread)| window + thread).collect();
    println!(
        "{name}: {} changes, median {:.3} ms: window {:.3} ms, run {:.3} ms",
        thread.len(),
        median(whole),
        median(window),
        median(thread)
    );
    Ok(())
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    1e3 * values.get(values.len() / 2).copied().unwrap_or(f64::NAN)
}
