//! Drawing on a device that a window has opened: with its limits, into its textures, and whatever goes wrong.

#[expect(dead_code, reason = "shared with other tests")]
mod stage;

use rendering::{
    AdapterChoice, Error, Gpu, PictureSpec, Renderer, Style, TexturePass, ViewLayout, Viewpoint,
};
use stage::{Path, Play};
use vocabulary::Picture;
use wgpu::{Limits, TextureFormat, TextureUsages};

const SIZE: (u32, u32) = (320, 200);

/// A device as a window opens it.
fn foreign(limits: Limits) -> Gpu {
    let wanted = AdapterChoice::from(std::env::var("ECHELON_ADAPTER").unwrap_or_default().as_str());
    let name = Gpu::open(&wanted).expect("tests of pictures need a graphics adapter").info().name.clone();
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
    let all = pollster::block_on(instance.enumerate_adapters(wgpu::Backends::all()));
    let adapter = all.into_iter().find(|a| a.get_info().name == name).unwrap();
    let descriptor = wgpu::DeviceDescriptor { required_limits: limits, ..Default::default() };
    let (device, queue) = pollster::block_on(adapter.request_device(&descriptor)).unwrap();
    Gpu::from_device(device, queue, &adapter.get_info())
}

fn target(gpu: &Gpu, (width, height): (u32, u32), format: TextureFormat) -> wgpu::Texture {
    gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: TextureUsages::RENDER_ATTACHMENT | TextureUsages::COPY_SRC | TextureUsages::TEXTURE_BINDING,
        view_formats: &[],
    })
}

fn wait(gpu: &Gpu) {
    gpu.device.poll(wgpu::PollType::wait_indefinitely()).unwrap();
}

/// The bytes of a texture whose rows are a multiple of 256 bytes long.
fn bytes(gpu: &Gpu, texture: &wgpu::Texture) -> Vec<u8> {
    let size = texture.size();
    let buffer = gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size: u64::from(4 * size.width * size.height),
        usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    });
    let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    let layout =
        wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(4 * size.width), rows_per_image: None };
    let copy = wgpu::TexelCopyBufferInfo { buffer: &buffer, layout };
    encoder.copy_texture_to_buffer(texture.as_image_copy(), copy, size);
    gpu.queue.submit([encoder.finish()]);
    buffer.map_async(wgpu::MapMode::Read, .., |result| result.unwrap());
    wait(gpu);
    buffer.get_mapped_range(..).unwrap().to_vec()
}

fn drawn(gpu: &Gpu, play: &Play, samples: u32, format: TextureFormat) -> (Vec<u8>, Picture) {
    let layout = ViewLayout { views: vec![Viewpoint::Snake, Viewpoint::Top] };
    let mut renderer = Renderer::with_format(gpu, &play.fleet, SIZE.0, SIZE.1, samples, format).unwrap();
    let texture = target(gpu, SIZE, format);
    let (trail, record, style) = (play.trail(3.0), play.at(3.0), Style::default());
    let view = texture.create_view(&wgpu::TextureViewDescriptor::default());
    renderer.draw_into(&view, PictureSpec::new(&trail, &record, &layout, &style)).unwrap();
    (bytes(gpu, &texture), renderer.draw(PictureSpec::new(&trail, &record, &layout, &style)).unwrap())
}

#[test]
fn a_foreign_texture_gets_the_same_picture() {
    let play = Play::new(3, Path::Eight);
    let mut own: Option<Picture> = None;
    for limits in [Limits::default(), Limits::downlevel_defaults(), Limits::downlevel_webgl2_defaults()] {
        let gpu = foreign(limits);
        for samples in [4, 1] {
            let (into, picture) = drawn(&gpu, &play, samples, TextureFormat::Rgba8Unorm);
            assert!(into == picture.rgba, "{samples} samples");
            if samples == 4 {
                assert!(*own.get_or_insert_with(|| picture.clone()) == picture);
            }
        }
    }
    // Where blue comes first, too.
    let gpu = foreign(Limits::default());
    let (mut into, picture) = drawn(&gpu, &play, 4, TextureFormat::Bgra8Unorm);
    into.chunks_exact_mut(4).for_each(|pixel| pixel.swap(0, 2));
    assert!(into == picture.rgba && own == Some(picture));
}

#[test]
fn a_picture_arrives_where_nobody_waits_for_it() {
    let gpu = foreign(Limits::downlevel_webgl2_defaults());
    let play = Play::new(3, Path::Eight);
    let mut renderer = Renderer::new(&gpu, &play.fleet, SIZE.0, SIZE.1, 4).unwrap();
    let (trail, record, style) = (play.trail(3.0), play.at(3.0), Style::default());
    let layout = ViewLayout::single(Viewpoint::Snake);
    let spec = PictureSpec::new(&trail, &record, &layout, &style);
    let wanted = renderer.draw(spec).unwrap();
    assert_eq!(renderer.arrived().unwrap(), None);
    assert!(renderer.draw_next(spec).unwrap().is_none());
    let arrived = std::iter::repeat_with(|| {
        std::thread::yield_now();
        renderer.arrived().unwrap()
    });
    assert!(arrived.flatten().next() == Some(wanted));
    assert_eq!(renderer.arrived().unwrap(), None);
}

#[test]
fn a_picture_is_laid_into_a_window_texel_by_texel_or_stretched() {
    let gpu = foreign(Limits::downlevel_webgl2_defaults());
    let format = TextureFormat::Rgba8Unorm;
    let play = Play::new(3, Path::Eight);
    let mut renderer = Renderer::with_format(&gpu, &play.fleet, SIZE.0, SIZE.1, 1, format).unwrap();
    let source = target(&gpu, SIZE, format);
    let view = source.create_view(&wgpu::TextureViewDescriptor::default());
    let (trail, record, style) = (play.trail(3.0), play.at(3.0), Style::default());
    let layout = ViewLayout::single(Viewpoint::Snake);
    renderer.draw_into(&view, PictureSpec::new(&trail, &record, &layout, &style)).unwrap();
    let laid = |pass: &TexturePass, (width, height): (u32, u32)| {
        let window = target(&gpu, (width, height), format);
        let onto = window.create_view(&wgpu::TextureViewDescriptor::default());
        let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        let attachment = wgpu::RenderPassColorAttachment {
            view: &onto,
            depth_slice: None,
            resolve_target: None,
            ops: wgpu::Operations::default(),
        };
        let descriptor = wgpu::RenderPassDescriptor {
            color_attachments: &[Some(attachment)],
            ..wgpu::RenderPassDescriptor::default()
        };
        pass.draw(&mut encoder.begin_render_pass(&descriptor), &pass.bind(&gpu, &view));
        gpu.queue.submit([encoder.finish()]);
        bytes(&gpu, &window)
    };
    let wanted = bytes(&gpu, &source);
    let stretching = TexturePass::stretching(&gpu, format);
    assert!(laid(&TexturePass::new(&gpu, format), SIZE) == wanted);
    // At its own size every centre of a pixel is that of a texel.
    assert!(laid(&stretching, SIZE) == wanted);
    let mean = |bytes: &[u8]| bytes.iter().map(|byte| f64::from(*byte)).sum::<f64>() / bytes.len() as f64;
    let twice = laid(&stretching, (2 * SIZE.0, 2 * SIZE.1));
    assert!((mean(&twice) - mean(&wanted)).abs() < 0.5, "{} {}", mean(&twice), mean(&wanted));
}

#[test]
fn renderers_share_a_device() {
    let gpu = foreign(Limits::default());
    let plays = [Play::new(3, Path::Eight), Play::new(7, Path::Circle)];
    let style = Style::default();
    let alone = plays.each_ref().map(|play| drawn(&gpu, play, 4, TextureFormat::Rgba8Unorm).1);
    let mut both = plays.each_ref().map(|play| {
        Renderer::with_format(&gpu, &play.fleet, SIZE.0, SIZE.1, 4, TextureFormat::Rgba8Unorm).unwrap()
    });
    let layout = ViewLayout { views: vec![Viewpoint::Snake, Viewpoint::Top] };
    for _ in 0..2 {
        for ((renderer, play), alone) in both.iter_mut().zip(&plays).zip(&alone) {
            assert!(
                renderer.draw(PictureSpec::new(&play.trail(3.0), &play.at(3.0), &layout, &style)).unwrap()
                    == *alone
            );
        }
    }
}

#[test]
fn what_does_not_fit_is_an_error_and_the_next_is_drawn() {
    let gpu = foreign(Limits::default());
    let play = Play::new(3, Path::Eight);
    let mut renderer = Renderer::new(&gpu, &play.fleet, SIZE.0, SIZE.1, 4).unwrap();
    let (trail, record, style) = (play.trail(1.0), play.at(1.0), Style::default());
    let layout = ViewLayout::single(Viewpoint::Snake);
    let view = |size, format| target(&gpu, size, format).create_view(&wgpu::TextureViewDescriptor::default());
    for (size, format) in [((64, 64), TextureFormat::Rgba8Unorm), (SIZE, TextureFormat::Rgba8UnormSrgb)] {
        let error = renderer
            .draw_into(&view(size, format), PictureSpec::new(&trail, &record, &layout, &style))
            .unwrap_err();
        assert!(matches!(error, Error::Device(_)), "{error}");
        let fits = view(SIZE, TextureFormat::Rgba8Unorm);
        renderer.draw_into(&fits, PictureSpec::new(&trail, &record, &layout, &style)).unwrap();
    }
}

#[test]
fn a_lost_device_is_an_error_every_time() {
    let gpu = foreign(Limits::default());
    let play = Play::new(3, Path::Eight);
    let mut renderer = Renderer::new(&gpu, &play.fleet, SIZE.0, SIZE.1, 4).unwrap();
    let texture = target(&gpu, SIZE, TextureFormat::Rgba8Unorm);
    let view = texture.create_view(&wgpu::TextureViewDescriptor::default());
    let (trail, record, style) = (play.trail(1.0), play.at(1.0), Style::default());
    let layout = ViewLayout::single(Viewpoint::Snake);
    renderer.draw_into(&view, PictureSpec::new(&trail, &record, &layout, &style)).unwrap();
    gpu.device.destroy();
    // What is already on the way may still arrive.
    let _ = gpu.device.poll(wgpu::PollType::wait_indefinitely());
    for _ in 0..2 {
        let into = renderer.draw_into(&view, PictureSpec::new(&trail, &record, &layout, &style));
        assert!(matches!(into, Err(Error::Device(_))), "{into:?}");
        let draw = renderer.draw(PictureSpec::new(&trail, &record, &layout, &style));
        assert!(matches!(draw, Err(Error::Device(_))), "{draw:?}");
        assert!(renderer.resize(300, 180).is_ok());
    }
    assert!(matches!(Renderer::new(&gpu, &play.fleet, 64, 64, 1), Err(Error::Device(_))));
}

/// A window whose edge is dragged for some seconds, with text that is never the same.
#[test]
fn memory_stays_bounded_while_a_window_is_dragged() {
    let gpu = foreign(Limits::default());
    let play = Play::new(3, Path::Eight);
    let mut renderer = Renderer::new(&gpu, &play.fleet, SIZE.0, SIZE.1, 4).unwrap();
    let held = || gpu.device.generate_allocator_report().map_or(0, |r| r.total_allocated_bytes);
    let (trail, layout) = (play.trail(1.0), ViewLayout::single(Viewpoint::Snake));
    let mut after = Vec::new();
    for k in 0..240_u32 {
        let size = (200 + (k * 7) % 60, 120 + (k * 5) % 40);
        renderer.resize(size.0, size.1).unwrap();
        let view = target(&gpu, size, TextureFormat::Rgba8Unorm)
            .create_view(&wgpu::TextureViewDescriptor::default());
        let style = Style { scale: 0.6 + 0.002 * f64::from(k % 90), ..Style::default() };
        let record = play.at(1.0 + 0.01 * f64::from(k));
        renderer.draw_into(&view, PictureSpec::new(&trail, &record, &layout, &style)).unwrap();
        if k % 40 == 39 {
            wait(&gpu);
            after.push(held());
        }
    }
    assert!(after[5] <= after[1] + 4_000_000, "{after:?}");
}

/// What stays on the device from picture to picture does not show.
#[test]
fn a_picture_does_not_hang_on_the_one_before() {
    let gpu = foreign(Limits::default());
    let play = Play::new(3, Path::Eight);
    let trail = play.trail(3.0);
    let style = Style::default();
    let mut kept = Renderer::new(&gpu, &play.fleet, SIZE.0, SIZE.1, 4).unwrap();
    // Still from another side, moved, failed and then drawn, and still again.
    let small = target(&gpu, (32, 32), TextureFormat::Rgba8Unorm);
    let small = small.create_view(&wgpu::TextureViewDescriptor::default());
    for (time, view) in
        [(3.0, Viewpoint::Snake), (3.0, Viewpoint::Orbit), (3.4, Viewpoint::Orbit), (3.4, Viewpoint::Top)]
    {
        let (record, layout) = (play.at(time), ViewLayout::single(view));
        let fresh = Renderer::new(&gpu, &play.fleet, SIZE.0, SIZE.1, 4)
            .and_then(|mut renderer| renderer.draw(PictureSpec::new(&trail, &record, &layout, &style)))
            .unwrap();
        assert!(kept.draw(PictureSpec::new(&trail, &record, &layout, &style)).unwrap() == fresh);
        assert!(kept.draw_into(&small, PictureSpec::new(&trail, &play.at(1.0), &layout, &style)).is_err());
        assert!(kept.draw(PictureSpec::new(&trail, &record, &layout, &style)).unwrap() == fresh);
        assert!(kept.draw(PictureSpec::new(&trail, &record, &layout, &style)).unwrap() == fresh);
    }
}

#[test]
fn quick_pictures_look_like_others() {
    let gpu = foreign(Limits::default());
    let play = Play::new(7, Path::Eight);
    let mut renderer = Renderer::new(&gpu, &play.fleet, 800, 560, 4).unwrap();
    let (trail, record) = (play.trail(40.0), play.at(40.0));
    for view in [Viewpoint::Snake, Viewpoint::Orbit, Viewpoint::Top] {
        let mut draw = |interactive: bool| {
            let style = Style { interactive, ..Style::default() };
            renderer
                .draw(PictureSpec::new(&trail, &record, &ViewLayout::single(view.clone()), &style))
                .unwrap()
        };
        let (whole, quick) = (draw(false), draw(true));
        let apart: Vec<_> = whole.rgba.iter().zip(&quick.rgba).map(|(a, b)| a.abs_diff(*b)).collect();
        let far = apart.iter().filter(|d| **d > 48).count();
        assert!(far * 2_000 < apart.len(), "{view:?}: {far} of {}", apart.len());
    }
}
