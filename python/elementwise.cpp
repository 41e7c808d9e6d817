#include "elementwise.hpp"

#include <pybind11/stl.h>

#include <span>

namespace monograin::python {
namespace {

/// Why a value cannot receive numbers, as the end of a sentence; empty: it can.
std::string why_no_output(const py::object& out) {
  const auto text = [](const py::object& value) { return py::str(value).cast<std::string>(); };
  if (!py::isinstance<py::array>(out)) {
    return "not " + py::module_::import("monograin._inputs").attr("shown")(out).cast<std::string>();
  }
  if (py::isinstance(out, py::module_::import("numpy.ma").attr("MaskedArray"))) {
    return "not a masked one; hand in its values, out.data, and set its mask yourself";
  }
  if (!py::isinstance<Array>(out)) {
    const bool is_native = out.attr("dtype").attr("isnative").cast<bool>();
    return "not one of " + text(out.attr("dtype")) + (is_native ? "" : ", whose byte order is not that of the machine");
  }
  return py::reinterpret_borrow<Array>(out).writeable() ? "" : "but this one is read-only";
}

/// @throws py::type_error for anything but a writable array of float64
/// @throws std::invalid_argument for an array of another shape
Array checked_output(const py::object& out, const std::vector<py::ssize_t>& shape) {
  if (const std::string why_not = why_no_output(out); !why_not.empty()) {
    throw py::type_error("out: expected a writable array of float64, " + why_not);
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
