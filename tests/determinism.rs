//! The same scene, seed and build: the same digest, whether or not pictures are drawn and on whatever thread.

use metrics::Digest;
use rendering::{AdapterChoice, Gpu, PictureSpec, Renderer, Style, Trail, ViewLayout, Viewpoint};
use scene::Scene;
use simulation::{Simulation, build};
use std::path::Path;

fn simulation(name: &str, mode: &str) -> Simulation {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes").join(name);
    // Scenes on wheels judge their errors from 5 s on, and have to last longer.
    let duration = if name.starts_with("cars-") { 6 } else { 3 };
    let overrides = [format!("time.duration={duration}"), format!("time.mode={mode}")]
        .map(|o| o.parse().expect("an override"));
    let loaded = Scene::load(path, &overrides).expect("a scene");
    Simulation::new(build(&loaded.scene).expect("a formation"))
}

fn digest(mut simulation: Simulation) -> String {
    let mut digest = Digest::default();
    while let Some(record) = simulation.next_record() {
        digest.push(record);
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

/// Wheels, rough ground, contacts: the same on one thread and on four, and after a save in the middle.
#[test]
fn physics_is_equal_bit_for_bit_on_any_thread_and_after_a_save() {
    for name in ["cars-rough.toml", "cars-slalom.toml", "cars-hundred.toml"] {
        let on = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
            pool.install(|| digest(simulation(name, "sampled")))
        };
        let one = on(1);
        assert_eq!(on(4), one, "{name}");
        let (mut run, mut sum) = (simulation(name, "sampled"), Digest::default());
        for _ in 0..150 {
            sum.push(run.next_record().expect("a moment"));
        }
        let mut saved = run.save();
        let mut resumed = sum.clone();
        while let Some(record) = run.next_record() {
            sum.push(record);
        }
        while let Some(record) = saved.next_record() {
            resumed.push(record);
        }
        assert_eq!((sum.text(), resumed.text()), (one.clone(), one), "{name}");
    }
}

#[test]
fn modes_make_different_runs() {
    assert_ne!(digest(simulation("seven-v.toml", "sampled")), digest(simulation("seven-v.toml", "measured")));
}

/// Noise of sensors belongs to the seed; a scene without any does not depend on it.
#[test]
fn seeds_make_different_runs_where_something_is_random() {
    let seeded = |sensing: &str, seed: u64| {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes/circle-three.toml");
        let overrides =
            ["time.duration=2".to_owned(), format!("sensing.kind={sensing}"), format!("seed={seed}")]
                .map(|o| o.parse().expect("an override"));
        let scene = Scene::load(path, &overrides).expect("a scene").scene;
        digest(Simulation::new(build(&scene).expect("a formation")))
    };
    assert_eq!(seeded("noise", 1), seeded("noise", 1));
    assert_ne!(seeded("noise", 1), seeded("noise", 2));
    assert_eq!(seeded("truth", 1), seeded("truth", 2));
}

#[test]
fn no_picture_changes_the_digest() {
    for name in ["seven-v.toml", "cars-ramp.toml"] {
        assert_eq!(drawn(name), digest(simulation(name, "sampled")));
    }
}

/// The digest of a run that is drawn now and then.
fn drawn(name: &str) -> String {
    let mut drawn = simulation(name, "sampled");
    let fleet = drawn.fleet().clone();
    let gpu = Gpu::open(&AdapterChoice::Auto).expect("an adapter; see `echelon doctor`");
    let mut renderer = Renderer::new(&gpu, &fleet, 160, 90, 4).expect("a renderer");
    let (mut trail, layout, style) =
        (Trail::new(&fleet), ViewLayout::single(Viewpoint::Snake), Style::default());
    let mut sum = Digest::default();
    let mut step = 0;
    while let Some(record) = drawn.next_record() {
        sum.push(record);
        trail.push(record);
        if step % 60 == 0 {
            renderer.draw(PictureSpec::new(&trail, record, &layout, &style)).expect("a picture");
        }
        step += 1;
    }
    sum.text()
}
