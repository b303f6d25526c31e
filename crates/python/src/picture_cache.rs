//! What draws moments of a simulation, ready for the next one.

use footage::{Audience, PictureOptions, RenderSetup};
use rendering::{AdapterChoice, Gpu};
use scene::Scene;
use std::collections::VecDeque;
use vocabulary::FleetInfo;

/// What has drawn pictures of a simulation.
#[derive(Default)]
pub(crate) struct PictureCache {
    gpu: Option<Gpu>,
    /// The last of them, each with what it draws.
    setups: VecDeque<(PictureOptions, RenderSetup)>,
}

/// Views of a step that are drawn in turn without being set up anew.
const SETUPS: usize = 8;

impl PictureCache {
    /// What draws pictures with these options.
    pub(crate) fn setup(
        &mut self,
        options: PictureOptions,
        scene: &Scene,
        fleet: &FleetInfo,
        adapter: &str,
        audience: &dyn Audience,
    ) -> Result<&mut RenderSetup, footage::Error> {
        if let Some(known) = self.setups.iter().position(|(known, _)| *known == options) {
            let last = self.setups.remove(known);
            self.setups.extend(last);
        } else {
            let open = || Gpu::open(&AdapterChoice::from(adapter)).map_err(footage::Error::from);
            let known = self.gpu.clone();
            let (view, size) = (&scene.views.default, scene.film.size);
            let setup =
                RenderSetup::on(|| known.map_or_else(open, Ok), &options, fleet, view, size, audience)?;
            self.gpu = Some(setup.gpu.clone());
            self.setups.push_back((options, setup));
            if self.setups.len() > SETUPS {
                self.setups.pop_front();
            }
        }
        let last = self.setups.back_mut().map(|(_, setup)| setup);
        last.ok_or_else(|| footage::Error::Machine("nothing is set up to draw".to_owned()))
    }
}
