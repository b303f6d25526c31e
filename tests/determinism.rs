//! The same scene, seed and build: the same digest, whether or not pictures are drawn and on whatever thread.

use recording::Digest;
use rendering::{AdapterChoice, Gpu, Layout, Renderer, Style, Trail, View};
use scene::Scene;
use simulation::{Simulation, build};
use std::path::Path;

fn simulation(name: &str, mode: &str) -> Simulation {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes").join(name);
    let overrides =
        ["time.duration=3", &format!("time.mode={mode}")].map(|o| o.parse().expect("an override"));
    let loaded = Scene::load(path, &overrides).expect("a scene");
    Simulation::new(build(&loaded.scene).expect("a formation"))
}

fn digest(mut simulation: Simulation) -> String {
    let mut digest = Digest::default();
    while let Some(moment) = simulation.next_moment() {
        digest.push(moment);
    }
    digest.text()
}

#[test]
fn runs_are_equal_bit_for_bit_on_any_thread() {
    for (name, mode) in
        [("seven-v.toml", "sampled"), ("circle-three.toml", "measured"), ("line-three.toml", "continuous")]
    {
        let here = digest(simulation(name, mode));
        let threads: Vec<_> =
            (0..3).map(|_| std::thread::spawn(move || digest(simulation(name, mode)))).collect();
        for thread in threads {
            assert_eq!(thread.join().expect("it ran"), here, "{name} {mode}");
        }
    }
}

#[test]
fn modes_and_seeds_make_different_runs() {
    assert_ne!(digest(simulation("seven-v.toml", "sampled")), digest(simulation("seven-v.toml", "measured")));
}

#[test]
fn no_picture_changes_the_digest() {
    let mut drawn = simulation("seven-v.toml", "sampled");
    let cast = drawn.cast().clone();
    let gpu = Gpu::open(&AdapterChoice::Auto).expect("an adapter; see `echelon doctor`");
    let mut renderer = Renderer::new(&gpu, &cast, 160, 90, 4).expect("a renderer");
    let (mut trail, layout, style) = (Trail::new(&cast), Layout::single(View::Snake), Style::default());
    let mut sum = Digest::default();
    let mut step = 0;
    while let Some(moment) = drawn.next_moment() {
        sum.push(moment);
        trail.push(moment);
        if step % 60 == 0 {
            renderer.draw(&trail, moment, &layout, &style).expect("a picture");
        }
        step += 1;
    }
    assert_eq!(sum.text(), digest(simulation("seven-v.toml", "sampled")));
}
