/// Functions of numbers, evaluated element by element over arrays that broadcast as in numpy.
#pragma once

#include <pybind11/numpy.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <functional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "bindings.hpp"
#include "interruptible.hpp"

namespace monograin::python {

using Array = py::array_t<double>;

/// Argument of a law: a number, or an array of numbers.
struct Numbers {
  Array array = py::reinterpret_steal<Array>(py::handle());
};

}  // namespace monograin::python

namespace pybind11::detail {

template <>
struct type_caster<monograin::python::Numbers> {
  PYBIND11_TYPE_CASTER(monograin::python::Numbers, const_name("numbers"));

  /// Floats, integers and plain arrays are taken as they are; monograin._inputs converts, or refuses, whatever else
  /// there is.
  bool load(handle source, bool /*convert*/) {
    const bool is_plain_array =
        Py_TYPE(source.ptr()) == npy_api::get().PyArray_Type_ &&
        std::string_view("fiub").find(reinterpret_borrow<array>(source).dtype().kind()) != std::string_view::npos;
    const bool is_plain = PyFloat_Check(source.ptr()) || PyLong_CheckExact(source.ptr()) || is_plain_array;
    if (is_plain) value.array = monograin::python::Array::ensure(source);
    if (!value.array) value.array = module_::import("monograin._inputs").attr("numbers")(source);
    return true;
  }
};

}  // namespace pybind11::detail

namespace monograin::python {

/// Elements of arrays that broadcast as in numpy, row by row.
template <std::size_t N>
class Elements {
 public:
  /// @throws std::invalid_argument for arrays whose shapes do not broadcast
  explicit Elements(const std::array<const Array*, N>& arrays) {
    for (const Array* array : arrays) widen(*array);
    std::ranges::reverse(shape_);
    index_.resize(shape_.size());
    for (std::size_t k = 0; k < N; ++k) {
      next_[k] = static_cast<const char*>(static_cast<const void*>(arrays[k]->data()));
      strides_[k].resize(shape_.size());
      const auto missing = shape_.size() - static_cast<std::size_t>(arrays[k]->ndim());
      for (std::size_t d = missing; d < shape_.size(); ++d) {
        const auto own = static_cast<py::ssize_t>(d - missing);
        if (arrays[k]->shape(own) != 1) strides_[k][d] = arrays[k]->strides(own);
      }
    }
  }

  /// Shape of the result.
  [[nodiscard]] const std::vector<py::ssize_t>& shape() const { return shape_; }

  /// The elements at one place of the result; the next call gives those at the next place.
  std::array<double, N> take() {
    std::array<double, N> values{};
    for (std::size_t k = 0; k < N; ++k) std::memcpy(&values[k], next_[k], sizeof(double));
    for (std::size_t d = shape_.size(); d-- > 0;) {
      const bool goes_on = ++index_[d] < shape_[d];
      for (std::size_t k = 0; k < N; ++k) next_[k] += goes_on ? strides_[k][d] : -strides_[k][d] * (shape_[d] - 1);
      if (goes_on) break;
      index_[d] = 0;
    }
    return values;
  }

 private:
  /// Widens the shape, from the last dimension on, by that of an array.
  void widen(const Array& array) {
    for (py::ssize_t k = 0; k < array.ndim(); ++k) {
      const py::ssize_t size = array.shape(array.ndim() - 1 - k);
      const auto place = static_cast<std::size_t>(k);
      if (place == shape_.size()) shape_.push_back(1);
      if (shape_[place] == 1) shape_[place] = size;
      if (size != 1 && size != shape_[place]) {
        throw std::invalid_argument("the arrays do not broadcast: one has " + std::to_string(shape_[place]) +
                                    " elements where another has " + std::to_string(size));
      }
    }
  }

  std::vector<py::ssize_t> shape_;
  std::vector<py::ssize_t> index_;
  std::array<std::vector<py::ssize_t>, N> strides_;  ///< [bytes]; 0 along dimensions that an array lacks
  std::array<const char*, N> next_{};
};

/// A function of numbers with its arguments, not yet evaluated.
class Elementwise {
 public:
  /// @throws std::invalid_argument for arrays whose shapes do not broadcast
  template <class Function, class... Arrays>
  explicit Elementwise(Function function, const Arrays&... numbers) : arguments_{numbers.array...} {
    Elements<sizeof...(numbers)> elements({&numbers.array...});
    shape_ = elements.shape();
    fill_ = [function = std::move(function), elements = std::move(elements)](double* values, py::ssize_t n) mutable {
      std::generate_n(values, n, [&] { return std::apply(function, elements.take()); });
    };
  }

  /// Evaluates all elements, once. Many are evaluated without the interpreter's lock, until a signal's handler raises.
  /// @param out  array that receives the values, or None
  /// @return `out`; for None a float if no argument has a dimension, or else a new array
  /// @throws py::type_error if `out` is no writable array of float64, or is masked
  /// @throws std::invalid_argument if `out` has another shape than the result
  [[nodiscard]] py::object into(const py::object& out);

 private:
  /// True if values can be written into `out` as they come, and no argument changes before it was read.
  [[nodiscard]] bool can_write_into(const Array& out) const;
  void evaluate(Array& result);

  std::vector<Array> arguments_;
  std::vector<py::ssize_t> shape_;
  std::function<void(double* values, py::ssize_t count)> fill_;  ///< writes the next values
};

}  // namespace monograin::python
