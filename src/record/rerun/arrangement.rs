//! A layout of the viewer as messages: views in containers, made at once, without the threads of Rerun's own streams.

use super::statics::Statics;
use ::rerun::external::re_log_types::BlueprintActivationCommand;
use ::rerun::external::re_sdk_types::blueprint::archetypes::{
    ContainerBlueprint, PanelBlueprint, TimeAxis, TimePanelBlueprint, ViewBlueprint, ViewContents, ViewportBlueprint,
};
use ::rerun::external::re_sdk_types::blueprint::components::{
    AutoLayout, AutoViews, ColumnShare, ContainerKind, IncludedContent, PanelState, QueryExpression, RootContainer,
    RowShare, ViewClass,
};
use ::rerun::external::re_sdk_types::datatypes::{Bool, Float32, Uuid};
use ::rerun::log::{LogMsg, RowId};
use ::rerun::{ApplicationId, AsComponents, StoreId, StoreKind};
use std::error::Error;

/// Kinds of view, by the viewer's names.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shows {
    Scene,
    Series,
    Document,
    Log,
}

impl Shows {
    fn class(self) -> &'static str {
        match self {
            Shows::Scene => "3D",
            Shows::Series => "TimeSeries",
            Shows::Document => "TextDocument",
            Shows::Log => "TextLog",
        }
    }
}

/// A view, and its properties by their names.
pub struct View {
    id: [u8; 16],
    shows: Shows,
    name: String,
    origin: &'static str,
    contents: &'static str,
    properties: Vec<(&'static str, Box<dyn AsComponents>)>,
}

impl View {
    /// A view of a path and all that is below it.
    pub fn new(shows: Shows, name: impl Into<String>, origin: &'static str) -> Self {
        View { id: id(), shows, name: name.into(), origin, contents: "$origin/**", properties: Vec::new() }
    }

    /// The same of other things.
    pub fn of(self, contents: &'static str) -> Self {
        View { contents, ..self }
    }

    pub fn add(&mut self, name: &'static str, property: impl AsComponents + 'static) {
        self.properties.push((name, Box::new(property)));
    }

    fn log(&self, stream: &mut Statics) -> Result<(), Box<dyn Error>> {
        let path = path("view", self.id);
        stream.log(format!("{path}/ViewContents"), &ViewContents::new([QueryExpression(self.contents.into())]))?;
        let view = ViewBlueprint::new(ViewClass(self.shows.class().into())).with_display_name(self.name.as_str());
        stream.log(path.as_str(), &view.with_space_origin(self.origin))?;
        for (name, property) in &self.properties {
            stream.log(format!("{path}/{name}"), property.as_ref())?;
        }
        Ok(())
    }
}

/// A view, or several pieces together.
pub enum Piece {
    View(View),
    Several(Several),
}

impl From<View> for Piece {
    fn from(view: View) -> Self {
        Piece::View(view)
    }
}

impl From<Several> for Piece {
    fn from(several: Several) -> Self {
        Piece::Several(several)
    }
}

impl Piece {
    fn path(&self) -> String {
        match self {
            Piece::View(view) => path("view", view.id),
            Piece::Several(several) => path("container", several.id),
        }
    }

    fn log(&self, stream: &mut Statics) -> Result<(), Box<dyn Error>> {
        match self {
            Piece::View(view) => view.log(stream),
            Piece::Several(several) => several.log(stream),
        }
    }
}

/// Pieces beside each other, one above another, or one behind another.
pub struct Several {
    id: [u8; 16],
    kind: ContainerKind,
    pieces: Vec<Piece>,
    shares: Vec<f32>,
}

impl Several {
    /// Pieces from left to right, with their shares of the width.
    pub fn beside(pieces: Vec<Piece>, shares: Vec<f32>) -> Self {
        Several { id: id(), kind: ContainerKind::Horizontal, pieces, shares }
    }

    /// Pieces from the top down, with their shares of the height.
    pub fn above(pieces: Vec<Piece>, shares: Vec<f32>) -> Self {
        Several { id: id(), kind: ContainerKind::Vertical, pieces, shares }
    }

    /// Pieces of which one is seen.
    pub fn tabs(pieces: Vec<Piece>) -> Self {
        Several { id: id(), kind: ContainerKind::Tabs, pieces, shares: Vec::new() }
    }

    fn log(&self, stream: &mut Statics) -> Result<(), Box<dyn Error>> {
        for piece in &self.pieces {
            piece.log(stream)?;
        }
        let contents = self.pieces.iter().map(|piece| IncludedContent(piece.path().into()));
        let container = ContainerBlueprint::new(self.kind).with_contents(contents);
        let shares = || self.shares.iter().map(|&share| Float32(share));
        let container = match self.kind {
            ContainerKind::Horizontal => container.with_col_shares(shares().map(ColumnShare)),
            ContainerKind::Vertical => container.with_row_shares(shares().map(RowShare)),
            _ => container,
        };
        stream.log(path("container", self.id), &container)
    }
}

/// Number of the piece under which the viewer keeps what views with linked axes share: one of its constants.
const LINKED: [u8; 16] =
    [0x5c, 0x0d, 0xca, 0x6a, 0xe6, 0x3f, 0x9c, 0xf7, 0xf6, 0x57, 0x26, 0x02, 0x59, 0x04, 0x74, 0xcc];

/// The layout of an application's recordings: a new store, all that is in it, and the word to show it; `linked` is the
/// axis of all plots whose axes are linked. The panels of the viewer itself are folded away.
///
/// # Errors
/// Rerun's own.
pub fn messages(
    application: ApplicationId,
    root: &Several,
    time: &TimePanelBlueprint,
    linked: Option<&TimeAxis>,
) -> Result<Vec<LogMsg>, Box<dyn Error>> {
    let store = StoreId::random(StoreKind::Blueprint, application);
    let mut stream = Statics::of_layout(store.clone());
    stream.open();
    root.log(&mut stream)?;
    let viewport = ViewportBlueprint::new().with_root_container(RootContainer(Uuid { bytes: root.id }));
    let viewport = viewport.with_auto_layout(AutoLayout(Bool(false))).with_auto_views(AutoViews(Bool(false)));
    stream.log("viewport", &viewport)?;
    for panel in ["blueprint_panel", "selection_panel"] {
        stream.log(panel, &PanelBlueprint::new().with_state(PanelState::Hidden))?;
    }
    stream.log("time_panel", time)?;
    if let Some(axis) = linked {
        stream.log(format!("{}/TimeAxis", path("view", LINKED)), axis)?;
    }
    let mut messages = stream.messages();
    messages.push(LogMsg::BlueprintActivationCommand(BlueprintActivationCommand::make_active(store)));
    Ok(messages)
}

/// A number that no other piece has.
fn id() -> [u8; 16] {
    RowId::new().as_bytes()
}

/// Path of a piece: its number as the viewer reads it.
fn path(kind: &str, id: [u8; 16]) -> String {
    let mut path = format!("{kind}/");
    for (i, byte) in id.iter().enumerate() {
        if [4, 6, 8, 10].contains(&i) {
            path.push('-');
        }
        path.push_str(&format!("{byte:02x}"));
    }
    path
}
