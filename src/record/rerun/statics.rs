//! Messages of an .rrd that are made at once: each a chunk, without the threads of Rerun's stream of a recording.

use super::out::{Appended, Times, chunk};
use ::rerun::components::Timestamp;
use ::rerun::external::re_log_types::{SetStoreInfo, StoreInfo, StoreSource};
use ::rerun::log::{Chunk, LogMsg, RowId};
use ::rerun::time::{TimePoint, Timeline};
use ::rerun::{AsComponents, EntityPath, RecordingInfo, Scalars, StoreId};

/// Messages of one store, in their order.
pub struct Statics {
    store: StoreId,
    at: TimePoint,
    messages: Vec<LogMsg>,
}

impl Statics {
    /// Messages for a recording.
    pub fn new(store: StoreId) -> Self {
        Statics { store, at: TimePoint::default(), messages: Vec::new() }
    }

    /// Messages for a layout, which has a time of its own.
    pub fn of_layout(store: StoreId) -> Self {
        let at = TimePoint::default().with(Timeline::new_sequence("blueprint"), 0);
        Statics { at, ..Statics::new(store) }
    }

    /// What comes first in a store.
    pub fn open(&mut self) {
        let source = StoreSource::Other("gotai".to_owned());
        let info = StoreInfo::new(self.store.clone(), source);
        self.messages.push(LogMsg::SetStoreInfo(SetStoreInfo { row_id: *RowId::new(), info }));
    }

    /// What opens a recording: its store, when it was made, and a name that the viewer lists it by.
    pub fn begin(&mut self, name: &str) -> Appended {
        self.open();
        self.log(EntityPath::properties(), &RecordingInfo::update_fields().with_start_time(Timestamp::now()))?;
        self.name(name)
    }

    /// A name, in the place of the one before.
    pub fn name(&mut self, name: &str) -> Appended {
        self.log(EntityPath::properties(), &RecordingInfo::update_fields().with_name(name))
    }

    /// Properties of the recording.
    pub fn property(&mut self, name: &str, values: &impl AsComponents) -> Appended {
        self.log(EntityPath::properties().join(&EntityPath::from(name)), values)
    }

    /// What holds at any time.
    pub fn log(&mut self, path: impl Into<EntityPath>, values: &(impl AsComponents + ?Sized)) -> Appended {
        let batches = values.as_serialized_batches();
        let chunk = Chunk::builder(path).with_serialized_batches(RowId::new(), self.at.clone(), batches).build()?;
        self.messages.push(LogMsg::ArrowMsg(self.store.clone(), chunk.to_arrow_msg()?));
        Ok(())
    }

    /// Numbers of a series at as many times.
    pub fn series(&mut self, path: &str, times: &Times, values: &[f64]) -> Appended {
        let columns = Scalars::update_fields().with_scalars(values.iter().copied()).columns_of_unit_batches()?;
        self.messages.push(chunk(&self.store, path.into(), times, columns)?);
        Ok(())
    }

    pub fn messages(self) -> Vec<LogMsg> {
        self.messages
    }
}
