//! What one of Rerun's stores is told, as messages: who it is, then chunks of one row.

use ::re_chunk::{Chunk, ChunkError, EntityPath, RowId, TimePoint, Timeline};
use ::re_log_types::{
    BlueprintActivationCommand, LogMsg, RecordingId, SetStoreInfo, StoreId, StoreInfo, StoreKind, StoreSource,
};
use ::re_sdk_types::AsComponents;

/// Application id: recordings of one application share a layout and are listed together.
const APPLICATION: &str = "gotai";

/// The one timeline of a layout.
const LAYOUT_TIME: &str = "blueprint";

pub struct Store {
    id: StoreId,
    time: TimePoint,
    messages: Vec<LogMsg>,
}

impl Store {
    /// Of a run; what is said here holds at all times.
    pub fn recording(id: String) -> Self {
        Self::new(StoreKind::Recording, id.into(), TimePoint::default())
    }

    /// Of a layout; every one is the viewer's first.
    pub fn layout() -> Self {
        let time = TimePoint::default().with(Timeline::new_sequence(LAYOUT_TIME), 0);
        Self::new(StoreKind::Blueprint, RecordingId::random(), time)
    }

    fn new(kind: StoreKind, id: RecordingId, time: TimePoint) -> Self {
        let id = StoreId::new(kind, APPLICATION, id);
        let info = StoreInfo::new(id.clone(), StoreSource::Other(APPLICATION.to_owned()));
        let first = LogMsg::SetStoreInfo(SetStoreInfo { row_id: *RowId::new(), info });
        Store { id, time, messages: vec![first] }
    }

    pub fn id(&self) -> &StoreId {
        &self.id
    }

    /// # Errors
    /// If the components of `what` have no common number of rows.
    pub fn say(&mut self, path: impl Into<EntityPath>, what: &dyn AsComponents) -> Result<(), ChunkError> {
        let row = what.as_serialized_batches();
        let chunk = Chunk::builder(path).with_serialized_batches(RowId::new(), self.time.clone(), row).build()?;
        self.messages.push(LogMsg::ArrowMsg(self.id.clone(), chunk.to_arrow_msg()?));
        Ok(())
    }

    /// The messages; a layout's end with its activation.
    pub fn into_messages(mut self) -> Vec<LogMsg> {
        if self.id.is_blueprint() {
            let activation =
                BlueprintActivationCommand { blueprint_id: self.id, make_active: true, make_default: true };
            self.messages.push(LogMsg::BlueprintActivationCommand(activation));
        }
        self.messages
    }
}
