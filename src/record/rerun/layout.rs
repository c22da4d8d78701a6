//! The layout that the viewer opens with: the scene beside its plots, events and configuration below.

use super::names::{APPLICATION, CONFIG, CONTACT_COUNT, CONTACT_FORCE, ENERGY, LOG, PENETRATION, SIM_TIME, WORLD};
use crate::record::sample::{Header, Streams};
use ::rerun::blueprint::{
    Blueprint, BlueprintActivation, BlueprintPanel, ContainerLike, Horizontal, SelectionPanel, Spatial3DView, Tabs,
    TextDocumentView, TextLogView, TimePanel, TimeSeriesView, Vertical,
};
use ::rerun::external::re_sdk_types::blueprint::archetypes::{EyeControls3D, PlotLegend};
use ::rerun::external::re_sdk_types::blueprint::components::{Corner2D, PanelState};
use ::rerun::log::LogMsg;
use ::rerun::{AsComponents, RecordingStreamBuilder, StoreId};
use std::error::Error;

/// Place of the camera, seen from the container's centre, in diagonals of the container: in front, to the right, above,
/// far enough for all of it.
const EYE: [f64; 3] = [0.48, 0.36, 0.90];

/// A plot, and whether it has more than one line.
type Plot = (TimeSeriesView, bool);

/// The layout as messages of a blueprint store, complete with its activation.
///
/// # Errors
/// Rerun's own.
pub fn messages(header: &Header) -> Result<Vec<LogMsg>, Box<dyn Error>> {
    let mut properties = Properties::default();
    let scene: ContainerLike = Spatial3DView::new("scene").with_origin(WORLD).into();
    if let Some(eye) = eye(header) {
        properties.add(&scene, "EyeControls3D", eye);
    }
    let mut plots = Vec::new();
    for (plot, several) in self::plots(header.streams) {
        let plot: ContainerLike = plot.into();
        properties.add(&plot, "PlotLegend", PlotLegend::new().with_visible(several).with_corner(Corner2D::RightTop));
        plots.push(plot);
    }

    // The public interface only sends a layout through a recording's stream; the recording is thrown away.
    let (stream, memory) = RecordingStreamBuilder::new(APPLICATION).enabled(true).memory()?;
    blueprint(scene, plots).send(&stream, BlueprintActivation::default())?;
    let mut messages = memory.take();
    let recording = memory.store_id();
    messages.retain(|message| Some(message.store_id()) != recording.as_ref());

    // The activation ends a layout; whatever comes later is not part of it.
    let last = messages.iter().rposition(|message| matches!(message, LogMsg::BlueprintActivationCommand(_)));
    if let Some(last) = last {
        let store = messages[last].store_id().clone();
        messages.splice(last..last, properties.messages(&store)?);
    }
    Ok(messages)
}

/// Properties of views that the public interface has no words for: camera, legend.
#[derive(Default)]
struct Properties(Vec<(String, Box<dyn AsComponents>)>);

impl Properties {
    fn add(&mut self, view: &ContainerLike, name: &str, value: impl AsComponents + 'static) {
        if let ContainerLike::View(view) = view {
            self.0.push((format!("{}/{name}", view.blueprint_path()), Box::new(value)));
        }
    }

    /// Messages of the layout's store.
    fn messages(&self, store: &StoreId) -> Result<Vec<LogMsg>, Box<dyn Error>> {
        let builder = RecordingStreamBuilder::from_store_id(store).enabled(true).send_properties(false);
        let (stream, memory) = builder.memory()?;
        stream.set_time_sequence("blueprint", 0);
        for (path, value) in &self.0 {
            stream.log(path.as_str(), value.as_ref())?;
        }
        let mut messages = memory.take();
        messages.retain(|message| matches!(message, LogMsg::ArrowMsg(..)));
        Ok(messages)
    }
}

fn blueprint(scene: ContainerLike, plots: Vec<ContainerLike>) -> Blueprint {
    let notes = Tabs::new([
        TextLogView::new("events").with_origin(LOG).into(),
        TextDocumentView::new("configuration").with_origin(CONFIG).into(),
    ]);
    let left = Vertical::new([scene, notes.into()]).with_row_shares([3.0, 1.0]);
    let root: ContainerLike = if plots.is_empty() {
        left.into()
    } else {
        Horizontal::new([left.into(), Vertical::new(plots).into()]).with_column_shares([3.0, 2.0]).into()
    };
    Blueprint::new(root)
        .with_auto_views(false)
        .with_auto_layout(false)
        .with_blueprint_panel(BlueprintPanel::from_state(PanelState::Collapsed))
        .with_selection_panel(SelectionPanel::from_state(PanelState::Collapsed))
        .with_time_panel(TimePanel::new().with_timeline(SIM_TIME).with_state(PanelState::Collapsed))
}

/// Only what is recorded has a plot.
fn plots(streams: Streams) -> Vec<Plot> {
    let plot = |name: &str, path: &str| TimeSeriesView::new(name).with_origin(path);
    [
        (streams.energy, plot("energy [J]", ENERGY), true),
        (streams.energy, plot("penetration [m]", PENETRATION), false),
        (streams.forces, plot("sum of |contact force| [N]", CONTACT_FORCE), false),
        (streams.contacts, plot("contacts", CONTACT_COUNT), false),
    ]
    .into_iter()
    .filter_map(|(on, plot, several)| on.then_some((plot, several)))
    .collect()
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
