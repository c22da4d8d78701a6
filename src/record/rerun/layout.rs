//! The layout that the viewer opens with: the scene beside its plots, events and configuration below.

use super::{CONFIG, CONTACT_COUNT, CONTACT_FORCE, ENERGY, LOG, PENETRATION, SIM_TIME, WORLD};
use crate::record::sample::{Header, Streams};
use ::rerun::blueprint::{
    Blueprint, BlueprintActivation, BlueprintPanel, ContainerLike, Horizontal, SelectionPanel, Spatial3DView, Tabs,
    TextDocumentView, TextLogView, TimePanel, TimeSeriesView, Vertical,
};
use ::rerun::external::re_sdk_types::blueprint::archetypes::EyeControls3D;
use ::rerun::external::re_sdk_types::blueprint::components::PanelState;
use ::rerun::log::LogMsg;
use ::rerun::{RecordingStreamBuilder, StoreId};
use std::error::Error;

/// Where the camera stands, seen from the container's centre, in diagonals of the container: in front, to the right,
/// above, far enough for all of it.
const EYE: [f64; 3] = [0.45, 0.35, 0.85];

/// The layout as messages of a blueprint store, complete with its activation.
pub fn messages(header: &Header) -> Result<Vec<LogMsg>, Box<dyn Error>> {
    let scene: ContainerLike = Spatial3DView::new("scene").with_origin(WORLD).into();
    let scene_path = match &scene {
        ContainerLike::View(view) => Some(view.blueprint_path().to_string()),
        _ => None,
    };
    // The public interface only sends a layout through a recording's stream; the recording is thrown away.
    let (stream, memory) = RecordingStreamBuilder::new(super::head::APPLICATION)
        .enabled(true)
        .memory()?;
    blueprint(header.streams, scene).send(&stream, BlueprintActivation::default())?;
    let mut messages = memory.take();
    let recording = memory.store_id();
    messages.retain(|message| Some(message.store_id()) != recording.as_ref());

    // The interface has no camera either: its property joins the layout, before the activation that ends it.
    let last = messages
        .iter()
        .rposition(|message| matches!(message, LogMsg::BlueprintActivationCommand(_)));
    if let (Some(path), Some(eye), Some(last)) = (scene_path, eye(header), last) {
        let store = messages[last].store_id().clone();
        messages.splice(last..last, property(&store, &format!("{path}/EyeControls3D"), &eye)?);
    }
    Ok(messages)
}

fn blueprint(streams: Streams, scene: ContainerLike) -> Blueprint {
    let notes = Tabs::new([
        TextLogView::new("events").with_origin(LOG).into(),
        TextDocumentView::new("configuration").with_origin(CONFIG).into(),
    ]);
    let left = Vertical::new([scene, notes.into()]).with_row_shares([3.0, 1.0]);
    let plots = plots(streams);
    let root: ContainerLike = if plots.is_empty() {
        left.into()
    } else {
        Horizontal::new([left.into(), Vertical::new(plots).into()])
            .with_column_shares([3.0, 2.0])
            .into()
    };
    Blueprint::new(root)
        .with_auto_views(false)
        .with_auto_layout(false)
        .with_blueprint_panel(BlueprintPanel::from_state(PanelState::Collapsed))
        .with_selection_panel(SelectionPanel::from_state(PanelState::Collapsed))
        .with_time_panel(
            TimePanel::new()
                .with_timeline(SIM_TIME)
                .with_state(PanelState::Collapsed),
        )
}

/// Only what is recorded has a plot.
fn plots(streams: Streams) -> Vec<ContainerLike> {
    let plot = |on: bool, name: &str, path: &str| on.then(|| TimeSeriesView::new(name).with_origin(path).into());
    [
        plot(streams.energy, "energy", ENERGY),
        plot(streams.energy, "penetration", PENETRATION),
        plot(streams.forces, "contact force", CONTACT_FORCE),
        plot(streams.contacts, "contacts", CONTACT_COUNT),
    ]
    .into_iter()
    .flatten()
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

/// A view's property as messages of the layout's store.
fn property(store: &StoreId, path: &str, value: &EyeControls3D) -> Result<Vec<LogMsg>, Box<dyn Error>> {
    let (stream, memory) = RecordingStreamBuilder::from_store_id(store)
        .enabled(true)
        .send_properties(false)
        .memory()?;
    stream.set_time_sequence("blueprint", 0);
    stream.log(path, value)?;
    let mut messages = memory.take();
    messages.retain(|message| matches!(message, LogMsg::ArrowMsg(..)));
    Ok(messages)
}
