/// A new HDF5 file on a disk that may be full.
#pragma once

#include "history/hdf5_library.hpp"

namespace monograin {

/// Keeps the errors of the system from the library of HDF5 while it writes a file. After a failed write the library
/// cannot close the file any more, and crashes when the process ends.
class Hdf5Output {
 public:
  /// @param calls  lives longer than this object
  explicit Hdf5Output(const Hdf5Calls& calls);
  Hdf5Output(const Hdf5Output&) = delete;
  Hdf5Output& operator=(const Hdf5Output&) = delete;

  /// Access to one new file, which ends before this object. The file is not locked: some network file systems refuse
  /// that.
  [[nodiscard]] hid_t access() const noexcept { return access_; }
  /// @throws std::runtime_error naming the file and the reason if something could not be written up to now
  void check() const;

 private:
  const Hdf5Calls* calls_;
  Hdf5Object driver_;
  Hdf5Object access_;
  int error_ = 0;  ///< errno of the first write that has failed
};

}  // namespace monograin
