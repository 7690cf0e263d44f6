//! Early requests to the memory for the cells that the next events will need.

use super::Cells;
use crate::instructions::prefetch;
use crate::simulation::state::Exit;

impl Cells {
    #[inline]
    pub(in crate::simulation) fn prefetch_place(&self, disk: usize) {
        prefetch(&self.places, disk);
    }

    /// Prefetches the nine cells around a disk of the smallest class. Does nothing for larger disks.
    #[inline]
    pub(in crate::simulation) fn prefetch_around(&self, disk: usize) {
        if self.is_large(disk) {
            return;
        }
        let (center, stride) = (self.grid.index(self.places[disk]), self.grid.stride());
        for middle in [center - stride, center, center + stride] {
            self.contents.prefetch(middle - 1);
            self.contents.prefetch(middle + 1);
        }
        self.prefetch_visitors(center);
    }

    #[inline]
    fn prefetch_visitors(&self, cell: usize) {
        if let Some(layers) = &self.layers {
            layers.prefetch_visitors(cell);
        }
    }

    /// Prefetches the cells that a disk leaves and enters by `exit`, and the cells that then come within its
    /// reach.
    #[inline]
    pub(in crate::simulation) fn prefetch_ahead(&self, disk: usize, exit: Exit) {
        let (from, to) = (self.places[disk], self.next_place(disk, exit));
        self.grid.prefetch_region(to);
        let (first, step) = self.three_ahead(to, exit);
        for cell in [self.grid.index(from), self.grid.index(to), first, first + step, first + 2 * step] {
            self.contents.prefetch(cell);
        }
        self.prefetch_visitors(self.grid.index(to));
    }
}
