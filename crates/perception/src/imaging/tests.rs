//! Light through glass, blur and noise, held against what it should be.

use super::*;
use vocabulary::math;

fn drawn(source: &IdealPicture, light: impl Fn(f64, f64) -> f64) -> Grey {
    let Region { width, height, .. } = source.region;
    let at = |k: u32| {
        let (x, y) = (f64::from(k % width), f64::from(k / width));
        light(x + f64::from(source.corner[0]), y + f64::from(source.corner[1])).round() as u8
    };
    Grey { width, height, values: (0..width * height).map(at).collect() }
}

fn taken(optics: Optics, region: Region, light: impl Fn(f64, f64) -> f64) -> Grey {
    let mut sensor = ImageSensor::new(optics);
    let ideal = drawn(&sensor.source(region), light);
    let mut picture = Grey::default();
    sensor.expose(&ideal, region, &mut noise_stream(1, 0, 0, Purpose::Pixels), &mut picture);
    assert_eq!((picture.width, picture.height), (region.width, region.height));
    picture
}

const REGION: Region = Region { x: 100, y: 60, width: 64, height: 48 };

#[test]
fn an_edge_becomes_as_soft_as_the_blur_says() {
    let optics = Optics { blur: 1.5, noise: 0.0, ..Optics::default() };
    let picture = taken(optics, REGION, |x, _| if x < 130.0 { 0.0 } else { 200.0 });
    let row = &picture.values[64 * 20..64 * 21];
    // The line's spread is the variance of the edge's slope.
    let slope: Vec<f64> = row.windows(2).map(|w| f64::from(w[1]) - f64::from(w[0])).collect();
    let total: f64 = slope.iter().sum();
    let mean = slope.iter().enumerate().map(|(k, s)| (k as f64 + 0.5) * s).sum::<f64>() / total;
    let square =
        slope.iter().enumerate().map(|(k, s)| math::powi(k as f64 + 0.5 - mean, 2) * s).sum::<f64>() / total;
    assert!((mean - 29.5).abs() < 0.02 && (square.sqrt() - 1.5).abs() < 0.05, "{mean} {}", square.sqrt());
}

#[test]
fn noise_is_as_strong_as_it_should_be() {
    let optics = Optics { blur: 0.0, noise: 4.0 / 255.0, ..Optics::default() };
    let picture = taken(optics, Region::whole(&optics.camera_model), |_, _| 120.0);
    let n = picture.values.len() as f64;
    let mean = picture.values.iter().map(|v| f64::from(*v)).sum::<f64>() / n;
    let square = picture.values.iter().map(|v| math::powi(f64::from(*v) - mean, 2)).sum::<f64>() / n;
    // Rounding to whole levels adds 1/12.
    assert!((mean - 120.0).abs() < 0.05 && (square - 16.0 - 1.0 / 12.0).abs() < 0.3, "{mean} {square}");
}

/// A pattern drawn through the pinhole and seen through the glass is where `CameraModel::direction` says.
#[test]
fn the_lens_bends_a_picture_as_it_bends_points() {
    let camera_model =
        CameraModel { distortion: [-0.28, 0.09, 1e-3, -7e-4, -0.01], ..CameraModel::default() };
    let optics = Optics { camera_model, blur: 0.0, noise: 0.0 };
    let light = |x: f64, y: f64| 128.0 + 100.0 * math::sin(x * 0.11) * math::cos(y * 0.13);
    for region in [REGION, Region { x: 0, y: 0, width: 90, height: 70 }, Region::whole(&camera_model)] {
        let picture = taken(optics, region, light);
        let mut worst = 0.0_f64;
        for (k, value) in picture.values.iter().enumerate() {
            let (x, y) = (k as u32 % region.width + region.x, k as u32 / region.width + region.y);
            let [u, v] = camera_model.direction([f64::from(x), f64::from(y)]);
            let wanted = light(
                camera_model.centre[0] + camera_model.focal * u,
                camera_model.centre[1] + camera_model.focal * v,
            );
            worst = worst.max((wanted - f64::from(*value)).abs());
        }
        assert!(worst < 2.0, "{worst}");
    }
}

/// Cutting a region out of a picture and taking a picture of the region are one.
#[test]
fn a_region_is_a_part_of_the_whole() {
    let camera_model = CameraModel { distortion: [-0.2, 0.05, 0.0, 0.0, 0.0], ..CameraModel::default() };
    for camera_model in [camera_model, CameraModel::default()] {
        let optics = Optics { camera_model, blur: 0.8, noise: 0.0 };
        let light = |x: f64, y: f64| 128.0 + 100.0 * math::sin(x * 0.4) * math::cos(y * 0.3);
        let (whole, part) =
            (taken(optics, Region::whole(&camera_model), light), taken(optics, REGION, light));
        for y in 0..REGION.height {
            let start = ((y + REGION.y) * 640 + REGION.x) as usize;
            let row = &part.values[(y * REGION.width) as usize..][..REGION.width as usize];
            let same = whole.values[start..].iter().zip(row).all(|(a, b)| a.abs_diff(*b) <= 1);
            assert!(same, "row {y}");
        }
    }
}

#[test]
fn an_ideal_picture_of_the_wrong_size_gives_none() {
    let mut sensor = ImageSensor::new(Optics::default());
    let mut picture = Grey::default();
    let mut stream = noise_stream(1, 0, 0, Purpose::Pixels);
    sensor.expose(&Grey::default(), REGION, &mut stream, &mut picture);
    assert!(picture.values.is_empty() && picture.width == 0);
    let nothing = Region::default();
    let source = sensor.source(nothing).region;
    let ideal = Grey {
        width: source.width,
        height: source.height,
        values: vec![9; (source.width * source.height) as usize],
    };
    sensor.expose(&ideal, nothing, &mut stream, &mut picture);
    assert!(picture.values.is_empty());
}
