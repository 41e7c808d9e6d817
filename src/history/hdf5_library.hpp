/// The library of HDF5, loaded when the first file of that format is written or read.
///
/// The program is not linked with it: with all that it depends on, it would add its time of loading to every start.
#pragma once

#include <hdf5.h>

#include <concepts>
#include <filesystem>
#include <mutex>
#include <string>
#include <string_view>
#include <utility>

// With these two, the header's constants call the linked library; without them they are numbers.
#undef H5CHECK
#undef H5OPEN
#define H5CHECK
#define H5OPEN

namespace monograin {

/// Functions of the library under their own names. Identifiers of types and classes are valid after H5open().
class Hdf5Library {
 public:
  /// @throws std::runtime_error with a remedy if the library is not installed, or is another one
  Hdf5Library();

 private:
  /// Address of a function or a variable, which becomes a pointer of its type.
  struct Symbol {
    void* address;
    template <class T>
    operator T*() const {  // NOLINT(google-explicit-constructor)
      return reinterpret_cast<T*>(address);
    }
  };
  [[nodiscard]] Symbol symbol(const char* name) const;

  void* library_;

 public:
  decltype(&::H5open) H5open = symbol("H5open");
  decltype(&::H5free_memory) H5free_memory = symbol("H5free_memory");
  decltype(&::H5Acreate2) H5Acreate2 = symbol("H5Acreate2");
  decltype(&::H5Aopen) H5Aopen = symbol("H5Aopen");
  decltype(&::H5Aread) H5Aread = symbol("H5Aread");
  decltype(&::H5Aget_space) H5Aget_space = symbol("H5Aget_space");
  decltype(&::H5Awrite) H5Awrite = symbol("H5Awrite");
  decltype(&::H5Dcreate2) H5Dcreate2 = symbol("H5Dcreate2");
  decltype(&::H5Dget_space) H5Dget_space = symbol("H5Dget_space");
  decltype(&::H5Dget_type) H5Dget_type = symbol("H5Dget_type");
  decltype(&::H5Dread) H5Dread = symbol("H5Dread");
  decltype(&::H5Dwrite) H5Dwrite = symbol("H5Dwrite");
  decltype(&::H5Eset_auto2) H5Eset_auto2 = symbol("H5Eset_auto2");
  decltype(&::H5Ewalk2) H5Ewalk2 = symbol("H5Ewalk2");
  decltype(&::H5FDregister) H5FDregister = symbol("H5FDregister");
  decltype(&::H5Fclose) H5Fclose = symbol("H5Fclose");
  decltype(&::H5Fcreate) H5Fcreate = symbol("H5Fcreate");
  decltype(&::H5Fopen) H5Fopen = symbol("H5Fopen");
  decltype(&::H5Gcreate2) H5Gcreate2 = symbol("H5Gcreate2");
  decltype(&::H5Gget_info) H5Gget_info = symbol("H5Gget_info");
  decltype(&::H5Idec_ref) H5Idec_ref = symbol("H5Idec_ref");
  decltype(&::H5Iget_type) H5Iget_type = symbol("H5Iget_type");
  decltype(&::H5Oopen_by_idx) H5Oopen_by_idx = symbol("H5Oopen_by_idx");
  decltype(&::H5Pcreate) H5Pcreate = symbol("H5Pcreate");
  decltype(&::H5Pget_driver_info) H5Pget_driver_info = symbol("H5Pget_driver_info");
  decltype(&::H5Pset_chunk) H5Pset_chunk = symbol("H5Pset_chunk");
  decltype(&::H5Pset_chunk_cache) H5Pset_chunk_cache = symbol("H5Pset_chunk_cache");
  decltype(&::H5Pset_deflate) H5Pset_deflate = symbol("H5Pset_deflate");
  decltype(&::H5Pset_driver) H5Pset_driver = symbol("H5Pset_driver");
  decltype(&::H5Pset_file_locking) H5Pset_file_locking = symbol("H5Pset_file_locking");
  decltype(&::H5Pset_link_creation_order) H5Pset_link_creation_order = symbol("H5Pset_link_creation_order");
  decltype(&::H5Pset_obj_track_times) H5Pset_obj_track_times = symbol("H5Pset_obj_track_times");
  decltype(&::H5Pset_shuffle) H5Pset_shuffle = symbol("H5Pset_shuffle");
  decltype(&::H5Pset_userblock) H5Pset_userblock = symbol("H5Pset_userblock");
  decltype(&::H5Screate) H5Screate = symbol("H5Screate");
  decltype(&::H5Screate_simple) H5Screate_simple = symbol("H5Screate_simple");
  decltype(&::H5Sget_simple_extent_ndims) H5Sget_simple_extent_ndims = symbol("H5Sget_simple_extent_ndims");
  decltype(&::H5Sget_simple_extent_npoints) H5Sget_simple_extent_npoints = symbol("H5Sget_simple_extent_npoints");
  decltype(&::H5Sselect_hyperslab) H5Sselect_hyperslab = symbol("H5Sselect_hyperslab");
  decltype(&::H5Tcopy) H5Tcopy = symbol("H5Tcopy");
  decltype(&::H5Tget_class) H5Tget_class = symbol("H5Tget_class");
  decltype(&::H5Tget_size) H5Tget_size = symbol("H5Tget_size");
  decltype(&::H5Tset_cset) H5Tset_cset = symbol("H5Tset_cset");
  decltype(&::H5Tset_size) H5Tset_size = symbol("H5Tset_size");
  decltype(&::H5Tset_strpad) H5Tset_strpad = symbol("H5Tset_strpad");
  const hid_t* file_creation = symbol("H5P_CLS_FILE_CREATE_ID_g");
  const hid_t* file_access = symbol("H5P_CLS_FILE_ACCESS_ID_g");
  const hid_t* group_creation = symbol("H5P_CLS_GROUP_CREATE_ID_g");
  const hid_t* dataset_creation = symbol("H5P_CLS_DATASET_CREATE_ID_g");
  const hid_t* dataset_access = symbol("H5P_CLS_DATASET_ACCESS_ID_g");
  const hid_t* stored_double = symbol("H5T_IEEE_F64LE_g");
  const hid_t* own_double = symbol("H5T_NATIVE_DOUBLE_g");
  const hid_t* text = symbol("H5T_C_S1_g");
};

/// An open file, dataset, type or other object of the library, closed with this object.
class Hdf5Object {
 public:
  Hdf5Object(const Hdf5Library& library, hid_t id) : library_(&library), id_(id) {}
  ~Hdf5Object() {
    if (id_ >= 0) library_->H5Idec_ref(id_);
  }
  Hdf5Object(Hdf5Object&& other) noexcept : library_(other.library_), id_(std::exchange(other.id_, H5I_INVALID_HID)) {}
  Hdf5Object& operator=(Hdf5Object&& other) noexcept {
    std::swap(library_, other.library_);
    std::swap(id_, other.id_);
    return *this;
  }

  operator hid_t() const noexcept { return id_; }  // NOLINT(google-explicit-constructor)
  /// Leaves the closing to the caller.
  [[nodiscard]] hid_t release() noexcept { return std::exchange(id_, H5I_INVALID_HID); }

 private:
  const Hdf5Library* library_;
  hid_t id_;
};

/// Calls the library for one file, and turns its errors into exceptions. The library is used by one thread at a time.
class Hdf5Calls {
 public:
  /// @param problem  first words of a message on the file: "cannot be written"
  Hdf5Calls(std::filesystem::path file, std::string_view problem);

  const Hdf5Library& library;

  /// @throws std::runtime_error naming the file and the reason if the result of a call is negative
  template <std::signed_integral Result>
  Result check(Result result) const {
    if (result < 0) fail(reason());
    return result;
  }
  /// The object that a call has opened. @throws std::runtime_error as check()
  [[nodiscard]] Hdf5Object object(hid_t id) const { return {library, check(id)}; }
  /// Text of fixed length [bytes], for cells.
  [[nodiscard]] Hdf5Object text_type(std::size_t bytes) const;
  /// Text of the length of each, for attributes.
  [[nodiscard]] Hdf5Object variable_text_type() const;
  /// Adds an attribute to a file or a dataset.
  void add_text(hid_t owner, const char* name, const std::string& text) const;
  /// Text of an attribute. @throws std::runtime_error as check(), and if it is not one text
  [[nodiscard]] std::string text_at(hid_t owner, const char* name) const;
  [[noreturn]] void fail(std::string_view reason) const;

 private:
  [[nodiscard]] Hdf5Object text_type(std::size_t bytes, H5T_str_t padding) const;
  [[nodiscard]] std::string reason() const;

  std::unique_lock<std::mutex> lock_;
  std::filesystem::path file_;
  std::string problem_;
};

}  // namespace monograin
