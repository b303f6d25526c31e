//! What a dragged value costs the lab before it shows what becomes of it: `drag SCENE DRAGS`, both optional. SCENE is a scene that
//! ships or a file. Where a lead robot has a goal that is dragged, otherwise a set point. Prints times of the work in the window, of
//! what the run makes of it, and of the next sample, which plans again.

use lab::action::Action;
use lab::app_state::AppState;
use lab::session::branches::Branches;
use lab::session::runner::{RunEvent, RunRequest};
use lab::view::annotations::goals;
use std::path::Path;
use std::sync::Arc;
use std::time::Instant;

/// How long the run has gone on before the first drag, s.
const BEGINS: f64 = 5.0;

fn main() -> Result<(), String> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let name = words.first().map_or("figure-eight-seven", String::as_str);
    let drags: usize = words.get(1).and_then(|word| word.parse().ok()).unwrap_or(200);
    let text = match scene::shipped(name) {
        Some(shipped) => shipped.text.to_owned(),
        None => std::fs::read_to_string(name).map_err(|error| format!("{name}: {error}"))?,
    };
    let mut app_state = AppState::new();
    app_state.open(text, None, Path::new("scene.toml"))?;
    app_state.requests.clear();
    let scene = Arc::clone(app_state.scene().ok_or("no scene")?);
    let mut run = Branches::open(scene, |_| ()).map_err(|error| error.to_string())?;
    let simulation = run.list()[0].simulation();
    let (fleet, period) = (Arc::new(simulation.fleet().clone()), simulation.period());
    app_state.handle_event(RunEvent::Opened { fleet, period });
    let goal = goals(&app_state).first().copied();
    if goal.is_some() {
        while run.advance(0).is_some_and(|record| record.snapshot.time < BEGINS) {}
    }
    let mut spent = [(); 3].map(|()| Vec::new());
    let mut plans = 0;
    for drag in 0..drags {
        let record = run.advance(0).ok_or("the run has ended")?.clone();
        app_state.handle_event(RunEvent::Records(0, vec![record]));
        let action = match goal {
            // To and fro over 1.5 m.
            Some((robot, number, [x, y])) => {
                let by = 0.1 * (drag % 30).min(30 - drag % 30) as f64 + 0.1;
                Action::Goal { robot, number, place: [x - by, y + 0.5 * by] }
            }
            None => Action::SetPoint { edge: 0, distance: 2.0 + 0.001 * drag as f64, bearing: 2.3 },
        };
        let began = Instant::now();
        app_state.act(&action);
        let window = began.elapsed().as_secs_f64();
        for request in std::mem::take(&mut app_state.requests) {
            let RunRequest::Change(checked) = request else { continue };
            let began = Instant::now();
            let change = run.change(0, &checked)?;
            drop(checked);
            let thread = began.elapsed().as_secs_f64();
            app_state.handle_event(RunEvent::Changed(0, change.ok_or("nothing has changed")?));
            let began = Instant::now();
            let record = run.advance(0).ok_or("the run has ended")?;
            let next = began.elapsed().as_secs_f64();
            plans += record.plans.len();
            for (all, value) in spent.iter_mut().zip([window, thread, next]) {
                all.push(value);
            }
        }
    }
    let whole: Vec<f64> = (0..spent[0].len()).map(|k| spent.iter().map(|times| times[k]).sum()).collect();
    let worst = 1e3 * whole.iter().copied().fold(0.0, f64::max);
    println!("{name}: {} changes, {plans} new plans", whole.len());
    println!("from a drag to what becomes of it: median {:.3} ms, at most {worst:.3} ms", median(whole));
    let [window, thread, next] = spent.map(median);
    println!("of that in the window {window:.3} ms, in the run {thread:.3} ms, the next sample {next:.3} ms");
    Ok(())
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    1e3 * values.get(values.len() / 2).copied().unwrap_or(f64::NAN)
}
