//! The index of a store: the headers of all pieces, by ramp and value.

use super::log::{HEAD, Piece};

/// The header of a record in a log.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Head {
    pub(crate) ramp: usize,
    pub(crate) value: usize,
    /// If a value has two records, the record of the higher edition counts. Records of equal editions have
    /// the same contents.
    pub(crate) edition: u16,
    pub(crate) marks: Marks,
    /// Wall-clock seconds that the value took; NaN if it was taken over.
    pub(crate) seconds: f32,
}

/// The header of a record, without its contents.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) struct Marks(u16);

impl Marks {
    /// The value counts as unfinished.
    pub(crate) const VOID: Self = Self(1);
    /// The value is the last of its ramp.
    pub(crate) const LAST: Self = Self(2);
    /// The value stalled, failed or reached a limit.
    pub(crate) const FAILED: Self = Self(4);
    /// The value's run has warnings.
    pub(crate) const WARNED: Self = Self(8);

    /// Adds a mark if `is_due` is true.
    pub(crate) const fn with(self, mark: Self, is_due: bool) -> Self {
        if is_due { Self(self.0 | mark.0) } else { self }
    }

    pub(crate) const fn has(self, mark: Self) -> bool {
        self.0 & mark.0 != 0
    }
}

impl Head {
    pub(super) fn bytes(&self) -> [u8; HEAD] {
        let mut bytes = [0; HEAD];
        // A plan has at most a million values, and a refinement adds some thousands in each ramp.
        bytes[..4].copy_from_slice(&(self.ramp as u32).to_le_bytes());
        bytes[4..8].copy_from_slice(&(self.value as u32).to_le_bytes());
        bytes[8..10].copy_from_slice(&self.edition.to_le_bytes());
        bytes[10..12].copy_from_slice(&self.marks.0.to_le_bytes());
        bytes[12..].copy_from_slice(&self.seconds.to_le_bytes());
        bytes
    }

    fn of(bytes: &[u8; HEAD]) -> Self {
        let number = |at: usize| u32::from_le_bytes([bytes[at], bytes[at + 1], bytes[at + 2], bytes[at + 3]]);
        Self {
            ramp: number(0) as usize,
            value: number(4) as usize,
            edition: number(8) as u16,
            marks: Marks((number(8) >> 16) as u16),
            seconds: f32::from_bits(number(12)),
        }
    }
}

/// The entry of a record, or of a value that counts as unfinished.
pub(crate) type Entry = Piece;

impl Entry {
    pub(crate) fn head(&self) -> Head {
        Head::of(&self.head)
    }

    fn place(&self) -> (usize, usize) {
        let Head { ramp, value, .. } = self.head();
        (ramp, value)
    }

    fn is_there(&self) -> bool {
        !self.head().marks.has(Marks::VOID)
    }
}

/// All entries, one for each ramp and value, in order.
#[derive(Debug, Clone, Default)]
pub(crate) struct Entries(Vec<Entry>);

impl Entries {
    pub(super) const fn count(&self) -> usize {
        self.0.len()
    }

    /// Adds an entry of a log at the end, before the entries are sorted.
    pub(super) fn push(&mut self, entry: Entry) {
        self.0.push(entry);
    }

    /// Sorts all entries. The first `sorted` entries are in order already.
    pub(super) fn settle(&mut self, sorted: usize) {
        let key = |entry: &Entry| (entry.place(), std::cmp::Reverse(entry.head().edition));
        // For partly sorted entries, a stable sort takes only linear time, but additional memory.
        match sorted {
            0 => self.0.sort_unstable_by_key(key),
            _ => self.0.sort_by_key(key),
        }
        self.0.dedup_by_key(|entry| entry.place());
    }

    /// Returns the entry of a value, even if the value counts as unfinished.
    pub(super) fn latest(&self, ramp: usize, value: usize) -> Option<Entry> {
        let place = self.0.binary_search_by_key(&(ramp, value), Entry::place).ok()?;
        Some(self.0[place])
    }

    /// Returns the record of a value.
    pub(crate) fn find(&self, ramp: usize, value: usize) -> Option<Entry> {
        self.latest(ramp, value).filter(Entry::is_there)
    }

    /// Iterates over all records.
    pub(crate) fn all(&self) -> impl Iterator<Item = &Entry> {
        self.0.iter().filter(|entry| entry.is_there())
    }

    /// Iterates over the records of some ramps.
    pub(crate) fn of(&self, ramps: std::ops::Range<usize>) -> impl Iterator<Item = &Entry> {
        let [from, to] =
            [ramps.start, ramps.end].map(|ramp| self.0.partition_point(|entry| entry.place() < (ramp, 0)));
        self.0[from..to].iter().filter(|entry| entry.is_there())
    }

    /// Returns whether all values of a ramp have a record.
    pub(crate) fn is_done(&self, ramp: usize) -> bool {
        let found = self.of(ramp..ramp + 1).map(Entry::head);
        let mut whole = found.enumerate().take_while(|(index, head)| head.value == *index);
        whole.any(|(_, head)| head.marks.has(Marks::LAST))
    }
}
