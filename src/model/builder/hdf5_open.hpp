// Opens HDF5 files, also on file systems without locks.
#pragma once

#include <hdf5.h>

#include <string>

namespace scree {

enum class Hdf5Open {
  create,  // a new file; must not exist
  read,
  modify
};

// Opens the file with these access properties; returns the library's result where that fails. The library
// locks open files so that nobody reads a file while it changes, and fails where the file system has no
// locks: NFS without lockd, Lustre mounted without flock, DVS. In that case the file is opened without a
// lock; the lock of the folder excludes other runs. The environment variable HDF5_USE_FILE_LOCKING takes
// precedence. creation: properties of a new file. The library keeps the reason of a failure until its next
// call: the caller must keep both property lists until it has read the reason.
hid_t open_hdf5(const std::string& path, Hdf5Open how, hid_t access, hid_t creation = H5P_DEFAULT);

}  // namespace scree
