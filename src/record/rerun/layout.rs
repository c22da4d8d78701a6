//! The layout that the viewer opens with: the scene beside its plots, events and configuration below.

use super::store::Store;
use super::{CONFIG, CONTACT_COUNT, CONTACT_FORCE, ENERGY, LOG, PENETRATION, SIM_TIME, WORLD};
use crate::record::sample::{Header, Streams};
use ::re_chunk::{ChunkError, EntityPath};
use ::re_log_types::LogMsg;
use ::re_sdk_types::blueprint::archetypes::{
    ContainerBlueprint, EyeControls3D, PanelBlueprint, PlotLegend, TimePanelBlueprint, ViewBlueprint, ViewContents,
    ViewportBlueprint,
};
use ::re_sdk_types::blueprint::components::{
    ContainerKind, Corner2D, IncludedContent, PanelState, RootContainer, ViewClass,
};
use ::re_sdk_types::external::uuid::Uuid;
use std::error::Error;

/// Where the camera stands, seen from the container's centre, in diagonals of the container: in front, to the right,
/// above, far enough for all of it.
const EYE: [f64; 3] = [0.48, 0.36, 0.90];

/// The layout as messages of a store of its own, complete with its activation.
pub fn messages(header: &Header) -> Result<Vec<LogMsg>, Box<dyn Error>> {
    let mut layout = Layout(Store::layout());
    let root = layout.root(header)?;
    layout.panels(root)?;
    Ok(layout.0.into_messages())
}

/// A view or a container, by its name in the store.
struct Part {
    id: Uuid,
    path: EntityPath,
}

impl Part {
    fn new(kind: &str) -> Self {
        let id = Uuid::new_v4();
        Part { id, path: format!("{kind}/{id}").into() }
    }
}

/// Views and containers in the viewer's own words; Rerun's builder of layouts comes with its network.
struct Layout(Store);

impl Layout {
    /// The scene above events and configuration; the plots, if any, beside them.
    fn root(&mut self, header: &Header) -> Result<Part, ChunkError> {
        let scene = self.view("3D", "scene", WORLD)?;
        if let Some(eye) = eye(header) {
            self.0.say(scene.path.join(&"EyeControls3D".into()), &eye)?;
        }
        let notes = [self.view("TextLog", "events", LOG)?, self.view("TextDocument", "configuration", CONFIG)?];
        let notes = self.container(ContainerKind::Tabs, &notes, &[])?;
        let left = self.container(ContainerKind::Vertical, &[scene, notes], &[3.0, 1.0])?;
        let mut shown = Vec::new();
        for Plot { name, origin, several, .. } in plots(header.streams) {
            let plot = self.view("TimeSeries", name, origin)?;
            let legend = PlotLegend::new().with_visible(several).with_corner(Corner2D::RightTop);
            self.0.say(plot.path.join(&"PlotLegend".into()), &legend)?;
            shown.push(plot);
        }
        if shown.is_empty() {
            return Ok(left);
        }
        let right = self.container(ContainerKind::Vertical, &shown, &[])?;
        self.container(ContainerKind::Horizontal, &[left, right], &[3.0, 2.0])
    }

    /// Shows what is recorded at and below `origin`.
    fn view(&mut self, class: &str, name: &str, origin: &str) -> Result<Part, ChunkError> {
        let view = Part::new("view");
        self.0.say(view.path.join(&"ViewContents".into()), &ViewContents::new(["$origin/**"]))?;
        let about = ViewBlueprint::new(ViewClass(class.into())).with_display_name(name).with_space_origin(origin);
        self.0.say(view.path.clone(), &about)?;
        Ok(view)
    }

    /// `shares`: of the height or the width, one a part; none: equal ones.
    fn container(&mut self, kind: ContainerKind, parts: &[Part], shares: &[f32]) -> Result<Part, ChunkError> {
        let container = Part::new("container");
        let contents = parts.iter().map(|part| IncludedContent(part.path.to_string().into()));
        let mut about = ContainerBlueprint::new(kind).with_contents(contents);
        if !shares.is_empty() {
            about = match kind {
                ContainerKind::Horizontal => about.with_col_shares(shares.iter().copied()),
                _ => about.with_row_shares(shares.iter().copied()),
            };
        }
        self.0.say(container.path.clone(), &about)?;
        Ok(container)
    }

    /// The viewer's own panels make room for the scene.
    fn panels(&mut self, root: Part) -> Result<(), ChunkError> {
        let viewport = ViewportBlueprint::new()
            .with_root_container(RootContainer(root.id.into()))
            .with_auto_layout(false)
            .with_auto_views(false);
        self.0.say("viewport", &viewport)?;
        let folded = PanelBlueprint::new().with_state(PanelState::Collapsed);
        self.0.say("blueprint_panel", &folded)?;
        self.0.say("selection_panel", &folded)?;
        let time = TimePanelBlueprint::new().with_timeline(SIM_TIME).with_state(PanelState::Collapsed);
        self.0.say("time_panel", &time)
    }
}

struct Plot {
    name: &'static str,
    origin: &'static str,
    /// Whether it has more than one line.
    several: bool,
    on: bool,
}

/// Only what is recorded has a plot.
fn plots(streams: Streams) -> impl Iterator<Item = Plot> {
    let plot = |on, name, origin, several| Plot { name, origin, several, on };
    [
        plot(streams.energy, "energy [J]", ENERGY, true),
        plot(streams.energy, "penetration [m]", PENETRATION, false),
        plot(streams.forces, "sum of |contact force| [N]", CONTACT_FORCE, false),
        plot(streams.contacts, "contacts", CONTACT_COUNT, false),
    ]
    .into_iter()
    .filter(|plot| plot.on)
}

/// The whole container in view; without one the viewer frames the bodies itself.
fn eye(header: &Header) -> Option<EyeControls3D> {
    let (low, high) = header.container_box_m()?;
    let size_m = header.scene_size_m();
    let centre: [f64; 3] = std::array::from_fn(|i| 0.5 * (low[i] + high[i]));
    let position: [f64; 3] = std::array::from_fn(|i| centre[i] + size_m * EYE[i]);
    let eye = EyeControls3D::new().with_position(position).with_look_target(centre);
    Some(eye.with_eye_up([0.0, 1.0, 0.0]))
}
