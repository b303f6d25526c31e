//! Scratch.
use perception::detect::{Detector, Locus};
use vocabulary::Grey;
fn main() {
    let mut locus = Locus::new();
    let mut counts = [0_usize; 6];
    let mut n = 0; let mut times = [0.0; 6];
    for path in std::env::args().skip(1) {
        let bytes = std::fs::read(&path).unwrap();
        let head: Vec<&[u8]> = bytes.splitn(4, |b| *b == b'\n').collect();
        let size: Vec<u32> = std::str::from_utf8(head[1]).unwrap().split(' ').map(|x| x.parse().unwrap()).collect();
        let values = head[3].to_vec();
        let g = Grey { width: size[0], height: size[1], values };
        let curve = |f: &dyn Fn(f64) -> f64| Grey { values: g.values.iter().map(|v| (255.0 * f(f64::from(*v) / 255.0)).clamp(0.0, 255.0) as u8).collect(), ..g.clone() };
        let (w, h) = (g.width as usize, g.height as usize);
        let mut soft: Vec<f64> = g.values.iter().map(|v| f64::from(*v)).collect();
        for y in 1..h - 1 { for x in 1..w - 1 {
            let at = |dx: usize, dy: usize| f64::from(g.values[(y + dy - 1) * w + x + dx - 1]);
            soft[y * w + x] = (at(0,0)+at(2,0)+at(0,2)+at(2,2) + 2.0*(at(1,0)+at(0,1)+at(2,1)+at(1,2)) + 4.0*at(1,1)) / 16.0;
        } }
        let curve2 = |f: &dyn Fn(f64) -> f64| Grey { values: soft.iter().map(|v| (255.0 * f(v / 255.0)).clamp(0.0, 255.0) as u8).collect(), ..g.clone() };
        let lg = |c: f64| curve2(&move |x: f64| (1.0 + c * x).ln() / (1.0 + c).ln());
        let pics = [curve2(&|x| x), lg(10.0), lg(20.0), lg(40.0), lg(80.0), curve2(&|x| x.sqrt())];
        n += 1;
        for (k, p) in pics.iter().enumerate() {
            let mut found = vec![];
            let t = std::time::Instant::now(); locus.detect(p, &mut found); times[k] += t.elapsed().as_secs_f64();
            counts[k] += found.len();
            if n % 40 == 1 { print!("{} ", found.len()); }
        }
        if n % 40 == 1 { println!("{path}"); }
    }
    println!("{:?}", times.map(|t| t / n as f64 * 1e3));
    println!("linear {} sqrt {} .4 {} x2 {} cube {} log {} of {n}", counts[0], counts[1], counts[2], counts[3], counts[4], counts[5]);
}
