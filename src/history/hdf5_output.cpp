#include "history/hdf5_output.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <memory>
#include <new>

namespace monograin {
namespace {

/// An open file of the driver, which the library knows by its base.
struct OutputFile : H5FD_t {
  int descriptor = -1;
  int* error = nullptr;   ///< receives errno of the first write that fails
  haddr_t allocated = 0;  ///< bytes that the library has allocated
  haddr_t written = 0;    ///< bytes up to the end of the last write
};

OutputFile& own(H5FD_t* file) { return *static_cast<OutputFile*>(file); }

void note_error(OutputFile& file) {
  if (*file.error == 0) *file.error = errno;
}

/// Transfers bytes piece by piece.
/// @param transfer  (bytes done) -> bytes transferred, 0 at the end of the file, or -1
/// @return number of bytes, less than `count` at the end of the file, where errno is zero, or after an error
template <class Transfer>
std::size_t transfer_all(std::size_t count, Transfer&& transfer) {
  std::size_t done = 0;
  while (done < count) {
    errno = 0;
    const ssize_t now = transfer(done);
    if (now < 0 && errno == EINTR) continue;
    if (now <= 0) break;
    done += static_cast<std::size_t>(now);
  }
  return done;
}

/// Driver of files in the system's file system, in which no write fails for the library: what follows the first failure
/// is lost.
const H5FD_class_t* driver_class(const Hdf5Library& hdf5) {
  static const Hdf5Library& library = hdf5;
  static const H5FD_class_t result = [] {
    H5FD_class_t made{};
    made.name = "monograin_output";
    made.maxaddr = INT64_MAX;
    made.fc_degree = H5F_CLOSE_WEAK;
    made.fapl_size = sizeof(int*);
    made.open = [](const char* name, unsigned, hid_t access, haddr_t) -> H5FD_t* {
      std::unique_ptr<OutputFile> file(new (std::nothrow) OutputFile);
      if (!file) return nullptr;
      std::memcpy(&file->error, library.H5Pget_driver_info(access), sizeof(int*));
      file->descriptor = open(name, O_RDWR | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
      if (file->descriptor >= 0) return file.release();
      note_error(*file);
      return nullptr;
    };
    made.close = [](H5FD_t* base) -> herr_t {
      const std::unique_ptr<OutputFile> file(&own(base));
      if (close(file->descriptor) != 0) note_error(*file);
      return 0;
    };
    made.query = [](const H5FD_t*, unsigned long* features) -> herr_t {
      *features = H5FD_FEAT_AGGREGATE_METADATA | H5FD_FEAT_ACCUMULATE_METADATA | H5FD_FEAT_DATA_SIEVE |
                  H5FD_FEAT_AGGREGATE_SMALLDATA | H5FD_FEAT_DEFAULT_VFD_COMPATIBLE;
      return 0;
    };
    made.get_eoa = [](const H5FD_t* file, H5FD_mem_t) { return static_cast<const OutputFile*>(file)->allocated; };
    made.set_eoa = [](H5FD_t* file, H5FD_mem_t, haddr_t end) -> herr_t {
      own(file).allocated = end;
      return 0;
    };
    made.get_eof = [](const H5FD_t* file, H5FD_mem_t) { return static_cast<const OutputFile*>(file)->written; };
    made.read = [](H5FD_t* file, H5FD_mem_t, hid_t, haddr_t begin, std::size_t count, void* bytes) -> herr_t {
      char* const to = static_cast<char*>(bytes);
      const std::size_t done = transfer_all(count, [&](std::size_t first) {
        return pread(own(file).descriptor, to + first, count - first, static_cast<off_t>(begin + first));
      });
      std::fill(to + done, to + count, '\0');  // beyond the end
      return done == count || errno == 0 ? 0 : -1;
    };
    made.write = [](H5FD_t* base, H5FD_mem_t, hid_t, haddr_t begin, std::size_t count, const void* bytes) -> herr_t {
      OutputFile& file = own(base);
      const char* const from = static_cast<const char*>(bytes);
      const std::size_t done = transfer_all(count, [&](std::size_t first) {
        return pwrite(file.descriptor, from + first, count - first, static_cast<off_t>(begin + first));
      });
      if (done < count) note_error(file);
      file.written = std::max(file.written, begin + count);
      return 0;
    };
    made.truncate = [](H5FD_t* base, hid_t, hbool_t) -> herr_t {
      OutputFile& file = own(base);
      if (file.written == file.allocated) return 0;
      if (ftruncate(file.descriptor, static_cast<off_t>(file.allocated)) != 0) note_error(file);
      file.written = file.allocated;
      return 0;
    };
    constexpr H5FD_mem_t k_kinds[H5FD_MEM_NTYPES] = H5FD_FLMAP_DICHOTOMY;
    std::ranges::copy(k_kinds, made.fl_map);
    return made;
  }();
  return &result;
}

}  // namespace

Hdf5Output::Hdf5Output(const Hdf5Calls& calls)
    : calls_(&calls),
      driver_(calls.object(calls.library.H5FDregister(driver_class(calls.library)))),
      access_(calls.object(calls.library.H5Pcreate(*calls.library.file_access))) {
  int* const error = &error_;
  calls.check(calls.library.H5Pset_driver(access_, driver_, &error));
}

void Hdf5Output::check() const {
  if (error_ != 0) calls_->fail(std::strerror(error_));
}

}  // namespace monograin
