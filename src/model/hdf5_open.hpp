// Opening HDF5 files wherever they are: also on file systems without locks.
#pragma once

#include <hdf5.h>

#include <string>

namespace scree {

enum class Hdf5Open {
  create,  // a new file; there must be none of this name
  read,
  modify
};

// Opens the file with these access properties, or returns what the library returns where it cannot. The
// library locks files as long as they are open, so that nobody reads what another one changes, and it refuses
// a file where the file system has no locks: NFS without lockd, Lustre mounted without flock, DVS. There the
// file is opened without a lock; the lock of the folder keeps other runs out. The environment variable
// HDF5_USE_FILE_LOCKING stands above both.
// chunk_index: of a new file; how many chunks a node of the library's index holds half of; 0: the library's
// own number, 32, whose nodes take 2 kB in every dataset.
hid_t open_hdf5(const std::string& path, Hdf5Open how, hid_t access, unsigned chunk_index = 0);

}  // namespace scree
