//! How the ground is written, and what is made of it.

use crate::{
    Ground, Noise, Patch, Relief,
    heights_file::{HEIGHT, HEIGHTS_FILE, wrong_length, wrong_size},
    relief,
    text::{
        Couple, Form, Found, Keys, Node, Reporter, Span,
        form::Number,
        integer, keys,
        keys::one_of,
        kinds::{Kind, Kinds},
        list, number, table,
    },
};
use serde_json::{Value as Json, json};
use std::sync::Arc;
use vocabulary::Terrain;

/// Side of a cell.
const CELL: Number = number("m").from(0.001).up_to(1000.0);
/// Length of waves.
const WAVELENGTH: Number = number("m").from(0.01).up_to(10_000.0);
/// What multiplies the tyres' own friction.
const FRICTION: Number = number("").from(0.01).up_to(2.0);
/// Most points of a grid.
const MOST_POINTS: f64 = 1e6;
/// Layers of bumps on rough ground.
const ROUGH_LAYERS: u32 = 3;
/// Side of the cells of flat ground, m.
const FLAT_CELL: f64 = 0.1;

/// A rectangle [x from, y from, x to, y to], m.
pub(crate) struct RegionForm;

impl Form for RegionForm {
    type Out = [f64; 4];

    fn read(&self, node: &Node, reporter: &mut Reporter) -> Option<[f64; 4]> {
        let items = node.as_list().unwrap_or_default();
        let numbers: Vec<_> = items.iter().filter_map(Node::as_number).collect();
        let region: Option<[f64; 4]> = numbers.try_into().ok();
        let held = |region: &[f64; 4]| region.iter().all(|at| number("m").holds(*at));
        let region = region.filter(held).filter(|[x0, y0, x1, y1]| x0 < x1 && y0 < y1);
        let expected = "a list [x from, y from, x to, y to] in m, each `from` below its `to`";
        reporter.expect(region, node, || expected.to_owned())
    }

    fn schema(&self) -> Json {
        json!({ "type": "array", "minItems": 4, "maxItems": 4, "items": number("m").schema() })
    }
}

keys! {
    /// Flat at z = 0.
    struct FlatKeys {
        /// Side of the cells in which patches are told apart, m.
        cell: f64 = CELL, or(FLAT_CELL);
    }
}

keys! {
    /// Bumps of many sizes; the smallest are a quarter as long as the largest.
    struct RoughKeys {
        /// Largest |height|, m.
        amplitude: f64 = number("m").from(0.0).up_to(100.0), or(0.02);
        /// Length of the largest waves, m.
        wavelength: f64 = WAVELENGTH, or(1.0);
        /// Same seed, same ground; the scene's `seed` if left out.
        seed: u64 = integer::<u64>(0, i64::MAX as u64), optional;
        /// Where it is rough, [x from, y from, x to, y to] in m; it fades to 0 within a wavelength of its edges.
        region: [f64; 4] = RegionForm, required;
        /// Side of a cell, m; at most a quarter of the wavelength.
        cell: f64 = CELL, or(0.1);
    }
}

keys! {
    /// Smooth hills and hollows.
    struct HillKeys {
        /// Largest |height|, m.
        amplitude: f64 = number("m").from(0.0).up_to(100.0), or(0.5);
        /// From hill to hill, m.
        wavelength: f64 = WAVELENGTH, or(10.0);
        /// Same seed, same ground; the scene's `seed` if left out.
        seed: u64 = integer::<u64>(0, i64::MAX as u64), optional;
        /// Where the hills are, [x from, y from, x to, y to] in m; they fade to 0 within a wavelength of its edges.
        region: [f64; 4] = RegionForm, required;
        /// Side of a cell, m; at most a quarter of the wavelength.
        cell: f64 = CELL, or(0.25);
    }
}

keys! {
    /// Heights measured or made elsewhere. Beyond its edges the ground goes on level.
    struct TableKeys {
        /// CSV file of heights in m beside the scene: no header, rows along x, the first with the smallest y; or give
        /// `heights`.
        file: Vec<Vec<f64>> = HEIGHTS_FILE, optional;
        /// Rows of heights in m along x, the first with the smallest y; or give `file`.
        heights: Vec<Vec<f64>> = list(list(HEIGHT, 0, 1_000_000), 0, 1_000_000), optional;
        /// The point with the smallest x and y, [m, m].
        origin: [f64; 2] = Couple(number("m"), number("m")), or([0.0; 2]);
        /// Distance between neighbouring points, m.
        cell: f64 = CELL, required;
    }
}

keys! {
    /// What all kinds of ground have.
    struct SharedKeys {
        /// Multiplies the tyres' own coefficient of friction.
        friction: f64 = FRICTION, or(1.0);
        /// Where it grips otherwise, blurred over a cell; the last one holds where several lie over each other.
        patches: Vec<PatchKeys> = list(table::<PatchKeys>(), 0, 1000), part;
    }
}

keys! {
    /// A place that grips otherwise.
    struct PatchKeys {
        /// Where it is, [x from, y from, x to, y to] in m.
        region: [f64; 4] = RegionForm, required;
        /// Multiplies the tyres' own coefficient of friction there.
        friction: f64 = FRICTION, required;
    }
}

/// A relief as it is written; without its seed, if that is the scene's.
#[derive(Debug)]
struct WrittenGround {
    relief: Relief,
    seeded: bool,
}

fn level(keys: FlatKeys, _: &Node, _: &mut Reporter) -> Option<WrittenGround> {
    Some(WrittenGround { relief: Relief::Flat { cell: keys.cell?.value }, seeded: true })
}

/// Checks noise and hands it on as the kind that `$relief` makes of it.
macro_rules! noise {
    ($make:ident, $keys:ident, $relief:path) => {
        fn $make(keys: $keys, _: &Node, reporter: &mut Reporter) -> Option<WrittenGround> {
            let (region, cell) = (keys.region?, keys.cell?);
            let noise = Noise {
                amplitude: keys.amplitude?.value,
                wavelength: keys.wavelength?.value,
                seed: keys.seed.as_ref().map_or(0, |seed| seed.value),
                region: region.value,
                cell: cell.value,
            };
            check_noise(&noise, cell.span, region.span, reporter)?;
            Some(WrittenGround { relief: $relief(noise), seeded: keys.seed.is_some() })
        }
    };
}
noise!(rough, RoughKeys, Relief::Rough);
noise!(hills, HillKeys, Relief::Hills);

fn check_noise(noise: &Noise, cell: Span, region: Span, reporter: &mut Reporter) -> Option<()> {
    if noise.cell > 0.25 * noise.wavelength {
        let message = format!(
            "`cell` of {} m is too coarse for waves of {} m: at most a quarter of `wavelength`",
            noise.cell, noise.wavelength
        );
        reporter.report(cell, message);
        return None;
    }
    check_points(noise.region, noise.cell, region, reporter)
}

/// Reports at `span` that a grid would have too many points.
fn check_points(region: [f64; 4], cell: f64, span: Span, reporter: &mut Reporter) -> Option<()> {
    let [columns, rows] = relief::grid(region, cell);
    if columns * rows <= MOST_POINTS {
        return Some(());
    }
    let message = format!(
        "{columns:.0} × {rows:.0} points with a `cell` of {cell} m; the most are {MOST_POINTS:.0}: take a larger `cell`"
    );
    reporter.report(span, message);
    None
}

fn heights(keys: TableKeys, node: &Node, reporter: &mut Reporter) -> Option<WrittenGround> {
    let (heights, from_file) = one_of(node, ["heights", "file"], [keys.heights, keys.file], reporter)?;
    if !from_file {
        let wanted = heights.value.first().map(Vec::len);
        let rows = heights.value.iter().zip(node.items("heights")).enumerate();
        let wrong = rows.filter_map(|(index, (row, node))| {
            Some((node.span, wrong_length(index + 1, row.len(), wanted)?))
        });
        let size = wrong_size(&heights.value).map(|fault| (heights.span, fault));
        if let Some((span, fault)) = wrong.chain(size).next() {
            reporter.report(span, fault);
            return None;
        }
    }
    let relief = Relief::Table { origin: keys.origin?.value, cell: keys.cell?.value, heights: heights.value };
    Some(WrittenGround { relief, seeded: true })
}

/// Kinds of ground.
const RELIEF: Kinds<WrittenGround> = Kinds {
    key: "kind",
    usual: Some("flat"),
    all: &[
        &Kind { word: "flat", make: level },
        &Kind { word: "rough", make: rough },
        &Kind { word: "hills", make: hills },
        &Kind { word: "table", make: heights },
    ],
};

/// A table that says what the ground is.
pub(crate) struct GroundForm;

/// The ground as it is written.
#[derive(Debug, Clone)]
pub(crate) struct GroundKeys {
    written: Arc<WrittenGround>,
    friction: f64,
    patches: Vec<Found<Patch>>,
}

impl Form for GroundForm {
    type Out = GroundKeys;

    fn read(&self, node: &Node, reporter: &mut Reporter) -> Option<GroundKeys> {
        let (written, shared) = RELIEF.read_with(node, reporter, SharedKeys::read)?;
        let patches = shared.patches?.value.into_iter().map(|keys| {
            let (region, friction) = (keys.region?, keys.friction?.value);
            Some(Found { span: region.span, value: Patch { region: region.value, friction } })
        });
        let patches = patches.collect::<Option<_>>()?;
        Some(GroundKeys { written: Arc::new(written?), friction: shared.friction?.value, patches })
    }

    fn schema(&self) -> Json {
        RELIEF.schema_with(SharedKeys::fields)
    }
}

/// The ground of a scene with this seed; `None` after reporting an error.
pub(crate) fn ground(keys: Option<&GroundKeys>, seed: u64, reporter: &mut Reporter) -> Option<Ground> {
    let Some(keys) = keys else {
        let relief = Relief::Flat { cell: FLAT_CELL };
        return Some(Ground { relief, friction: 1.0, patches: vec![], terrain: None });
    };
    let mut relief = keys.written.relief.clone();
    if let Relief::Rough(noise) | Relief::Hills(noise) = &mut relief
        && !keys.written.seeded
    {
        noise.seed = seed;
    }
    let friction = keys.friction;
    let patches: Vec<_> = keys.patches.iter().map(|patch| patch.value).collect();
    let mut terrain = match &relief {
        Relief::Flat { .. } if friction == 1.0 && patches.is_empty() => {
            return Some(Ground { relief, friction, patches, terrain: None });
        }
        Relief::Flat { cell } => flat(*cell, &keys.patches, reporter)?,
        Relief::Rough(noise) => relief::make(noise, ROUGH_LAYERS),
        Relief::Hills(noise) => relief::make(noise, 1),
        Relief::Table { origin, cell, heights } => Terrain {
            origin: *origin,
            cell: *cell,
            columns: heights.first().map_or(0, Vec::len),
            rows: heights.len(),
            heights: heights.concat(),
            grip: vec![],
        },
    };
    check_patches(&keys.patches, &terrain, reporter);
    terrain.grip = grip(&terrain, friction, &patches);
    Some(Ground { relief, friction, patches, terrain: Some(Arc::new(terrain)) })
}

/// Flat ground, just around its patches.
fn flat(cell: f64, patches: &[Found<Patch>], reporter: &mut Reporter) -> Option<Terrain> {
    let Some(first) = patches.first() else { return Some(relief::level([0.0, 0.0, cell, cell], cell)) };
    let [x0, y0, x1, y1] = patches.iter().fold(first.value.region, |[a, b, c, d], patch| {
        let [x0, y0, x1, y1] = patch.value.region;
        [a.min(x0), b.min(y0), c.max(x1), d.max(y1)]
    });
    let around = [x0 - cell, y0 - cell, x1 + cell, y1 + cell];
    check_points(around, cell, first.span, reporter)?;
    Some(relief::level(around, cell))
}

/// Reports patches that the grid cannot show: beyond its edges the ground goes on as it is there, without end.
fn check_patches(patches: &[Found<Patch>], terrain: &Terrain, reporter: &mut Reporter) {
    let Terrain { origin: [x, y], cell, columns, rows, .. } = *terrain;
    let [right, left] = [x + (columns - 1) as f64 * cell, y + (rows - 1) as f64 * cell];
    for patch in patches {
        let [x0, y0, x1, y1] = patch.value.region;
        if x0 <= x || y0 <= y || x1 >= right || y1 >= left {
            let message =
                format!("a patch must lie inside the ground, from [{x}, {y}] to [{right}, {left}] in m");
            reporter.report(patch.span, message);
        } else if (x1 - x0).min(y1 - y0) < cell {
            let message = format!("a patch must be as wide and long as a `cell` of the ground, {cell} m");
            reporter.report(patch.span, message);
        }
    }
}

/// Friction at every point; empty where it is 1 everywhere.
fn grip(terrain: &Terrain, friction: f64, patches: &[Patch]) -> Vec<f64> {
    if friction == 1.0 && patches.is_empty() {
        return vec![];
    }
    let Terrain { origin, cell, columns, rows, .. } = *terrain;
    let mut grip = vec![friction; columns * rows];
    for Patch { region: [x0, y0, x1, y1], friction } in patches {
        // First point at or after `from`, and number of points up to `to`.
        let span = |from: f64, to: f64, origin: f64, points: usize| {
            let first = ((from - origin) / cell - 1e-9).ceil().max(0.0) as usize;
            first..points.min((((to - origin) / cell + 1e-9).floor() + 1.0).max(0.0) as usize)
        };
        for row in span(*y0, *y1, origin[1], rows) {
            let across = span(*x0, *x1, origin[0], columns);
            if let Some(points) = grip.get_mut(row * columns + across.start..row * columns + across.end) {
                points.fill(*friction);
            }
        }
    }
    grip
}
