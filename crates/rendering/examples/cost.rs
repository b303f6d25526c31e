#[path = "../tests/stage/mod.rs"]
mod stage;
use rendering::*;
use stage::{Path, Play};
fn cpu() -> f64 { let s = std::fs::read_to_string("/proc/self/stat").unwrap(); let f: Vec<&str> = s.rsplit(')').next().unwrap().split_whitespace().collect(); (f[11].parse::<f64>().unwrap() + f[12].parse::<f64>().unwrap()) * 10.0 }
fn main() {
    let a: Vec<String> = std::env::args().skip(1).collect();
    let play = Play::new(a[2].parse().unwrap(), Path::Eight);
    let gpu = Gpu::open(&AdapterChoice::from(a[0].as_str())).unwrap();
    let names: Vec<_> = play.cast.members.iter().map(|m| m.name.clone()).collect();
    let trail = play.trail(12.0); let m = play.at(12.0);
    let layout = Layout::parse(&a[1], &names).unwrap();
    let without: Vec<&str> = a[4].split(',').filter(|s| !s.is_empty()).collect();
    let style = if a[4] == "bare" { Style::bare() } else { Style::without(&without).unwrap() };
    let mut r = Renderer::new(&gpu, &play.cast, 1280, 720, a[3].parse().unwrap()).unwrap();
    for _ in 0..3 { r.draw(&trail, &m, &layout, &style).unwrap(); }
    let (c, t) = (cpu(), std::time::Instant::now());
    let n = 30;
    let mut each = vec![];
    for _ in 0..n { let t = std::time::Instant::now(); r.draw(&trail, &m, &layout, &style).unwrap(); each.push(t.elapsed().as_secs_f64()*1e3); }
    each.sort_by(f64::total_cmp);
    println!("{:?}: cpu {:.1} ms wall {:.1} ms median {:.1} min {:.1}", a, (cpu() - c) / n as f64, t.elapsed().as_secs_f64() * 1e3 / n as f64, each[n/2], each[0]);
}
