#include "model/builder/hdf5_open.hpp"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>

#if !H5_VERSION_GE(1, 12, 1) && (!H5_VERSION_GE(1, 10, 7) || H5_VERSION_GE(1, 11, 0))
#error "Scree needs HDF5 1.10.7, 1.12.1 or newer, which can do without locks (H5Pset_file_locking)"
#endif

namespace scree {
namespace {

herr_t find_lock_error(unsigned, const H5E_error2_t* error, void* number) {
  const std::string text = error->desc == nullptr ? "" : error->desc, mark = "unable to lock file, errno = ";
  const std::size_t at = text.find(mark);
  if (at != std::string::npos) *static_cast<int*>(number) = std::atoi(text.c_str() + at + mark.size());
  return 0;
}

// Whether the library failed to lock a file that nobody else has locked.
bool lacks_locks() {
  constexpr std::array kHeld = {0, EWOULDBLOCK, EAGAIN, EACCES};
  int number = 0;
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, find_lock_error, &number);
  return std::ranges::find(kHeld, number) == kHeld.end();
}

hid_t open_once(const std::string& path, Hdf5Open how, hid_t access, hid_t creation) {
  if (how == Hdf5Open::create) return H5Fcreate(path.c_str(), H5F_ACC_EXCL, creation, access);
  return H5Fopen(path.c_str(), how == Hdf5Open::read ? H5F_ACC_RDONLY : H5F_ACC_RDWR, access);
}

}  // namespace

hid_t open_hdf5(const std::string& path, Hdf5Open how, hid_t access, hid_t creation) {
  const hid_t file = open_once(path, how, access, creation);
  if (file >= 0 || !lacks_locks()) return file;
  if (how == Hdf5Open::create)
    unlink(path.c_str());  // the library creates the file before it tries to lock it
  H5Pset_file_locking(access, false, true);
  return open_once(path, how, access, creation);
}

}  // namespace scree
