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
// creation: properties of a new file. The library keeps the reason of a failure until it is called again: the
// caller keeps both lists of properties until it has read it.
hid_t open_hdf5(const std::string& path, Hdf5Open how, hid_t access, hid_t creation = H5P_DEFAULT);

}  // namespace scree
