#include "elementwise.hpp"

#include <pybind11/stl.h>

#include <span>

namespace monograin::python {
namespace {

/// @throws py::type_error for anything but a writable array of float64
/// @throws std::invalid_argument for an array of another shape
Array checked_output(const py::object& out, const std::vector<py::ssize_t>& shape) {
  const bool is_right = py::isinstance<Array>(out) && py::reinterpret_borrow<Array>(out).writeable();
  if (!is_right) {
    const py::object shown = py::module_::import("monograin._inputs").attr("shown")(out);
    throw py::type_error("out: expected a writable array of float64, not " + shown.cast<std::string>());
  }
  Array array = py::reinterpret_borrow<Array>(out);
  if (!std::ranges::equal(std::span(array.shape(), static_cast<std::size_t>(array.ndim())), shape)) {
    const auto text = [](const py::object& tuple) { return py::str(tuple).cast<std::string>(); };
    throw std::invalid_argument("out: its shape is " + text(out.attr("shape")) + "; expected that of the result, " +
                                text(py::tuple(py::cast(shape))));
  }
  return array;
}

}  // namespace

py::object Elementwise::into(const py::object& out) {
  if (out.is_none()) {
    Array result(shape_);
    evaluate(result);
    return shape_.empty() ? py::object(py::float_(*result.data())) : py::object(result);
  }
  Array target = checked_output(out, shape_);
  if (can_write_into(target)) {
    evaluate(target);
  } else {
    Array result(shape_);
    evaluate(result);
    out[py::ellipsis()] = result;
  }
  return out;
}

bool Elementwise::can_write_into(const Array& out) const {
  const py::object may_share_memory = py::module_::import("numpy").attr("may_share_memory");
  const auto is_contiguous = [](const Array& array) { return (array.flags() & py::array::c_style) != 0; };
  return is_contiguous(out) && std::ranges::all_of(arguments_, [&](const Array& argument) {
           const bool has_same_elements =
               argument.data() == out.data() && argument.size() == out.size() && is_contiguous(argument);
           return has_same_elements || !may_share_memory(argument, out).cast<bool>();
         });
}

void Elementwise::evaluate(Array& result) {
  constexpr py::ssize_t k_piece = 2048;
  double* const values = result.mutable_data();
  const py::ssize_t count = result.size();
  if (count <= k_piece) {
    fill_(values, count);
    return;
  }
  SignalWatch signals;
  {
    const Unlocked unlocked;
    for (py::ssize_t begin = 0; begin < count && !signals.has_raised(); begin += k_piece) {
      fill_(values + begin, std::min(k_piece, count - begin));
    }
  }
  signals.rethrow();
}

}  // namespace monograin::python
