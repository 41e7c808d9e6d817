#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "history/table.hpp"
#include "mdr/contact.hpp"
#include "models/accuracy.hpp"

namespace monograin::mdr::point_values_test {
namespace {

const Table& point_values() {
  static const Table table = read_csv(MONOGRAIN_SOURCE_DIR "/tests/models/mdr/reference/point_values.csv");
  return table;
}

/// One evaluation of the contact law in 40-digit arithmetic; lengths over R0, stresses over E.
class Row {
 public:
  explicit Row(std::size_t index) : index_(index) {}

  [[nodiscard]] std::string_view word(std::string_view name) const {
    return point_values().word(index_, point_values().find(name).value());
  }
  /// Columns with blank cells hold words, even where the word is a number.
  [[nodiscard]] double operator[](std::string_view name) const {
    const std::size_t column = point_values().find(name).value();
    return point_values().columns()[column].holds_words() ? std::stod(std::string(word(name)))
                                                          : point_values().at(index_, column);
  }
  [[nodiscard]] Material material() const { return make_material(1.0, (*this)["nu"], 1.0 / (*this)["E_over_Y"]); }

  void expect(std::string_view name, double actual, double tolerance) const {
    EXPECT_LE(relative_error(actual, (*this)[name]), tolerance)
        << name << " in data row " << index_ << ": " << actual << " instead of " << (*this)[name];
  }

 private:
  std::size_t index_;
};

std::vector<Row> rows_without_adhesion(std::string_view state) {
  std::vector<Row> rows;
  for (std::size_t i = 0; i < point_values().row_count(); ++i) {
    if (Row row(i); row.word("adh") == "none" && row.word("state") == state) rows.push_back(row);
  }
  return rows;
}

constexpr double k_round_off = 8 * k_epsilon;  // largest error found: 7.1e-16

void expect_contact(const Row& row, const Contact& contact, double tolerance) {
  row.expect("a_over_R0", contact.contact_radius, tolerance);
  row.expect("F_over_ER02", contact.force, tolerance);
  row.expect("F_delta_over_ER0", contact.by_overlap, tolerance);
  row.expect("F_R_over_ER0", contact.by_radius, tolerance);
}

void expect_shape(const Row& row, const UnloadingShape& shape) {
  row.expect("pY_over_E", shape.pressure, k_round_off);
  row.expect("A_over_R0", shape.height, k_round_off);
  row.expect("B_over_R0", 2.0 * shape.contact_radius_max, k_round_off);
  row.expect("rho", shape.rho, k_round_off);
}

UnloadingShape shape_of(const Row& row) {
  return unloading_shape(row.material(), row["R_over_R0"], row["delta_max_over_R0"], row["cA_over_pi_R02"]);
}

TEST(MdrPointValues, YieldOverlapIsMet) {
  for (const std::string_view state : {"el", "pv", "pu"}) {
    for (const Row& row : rows_without_adhesion(state)) {
      row.expect("d_Y", row.material().yield_overlap_ratio, k_round_off);
    }
  }
}

TEST(MdrPointValues, ElasticContactIsMet) {
  const auto rows = rows_without_adhesion("el");
  ASSERT_EQ(rows.size(), 3u);
  for (const Row& row : rows) {
    const auto profile = row.word("elastic_profile") == "parabola" ? ElasticProfile::parabola : ElasticProfile::ellipse;
    const double modulus = row.material().composite_modulus;
    expect_contact(row, elastic_contact(profile, modulus, row["R_over_R0"], row["delta_over_R0"]), k_round_off);
  }
}

TEST(MdrPointValues, PlasticContactIsMet) {
  const auto rows = rows_without_adhesion("pv");
  ASSERT_EQ(rows.size(), 2u);
  for (const Row& row : rows) {
    expect_contact(row, plastic_contact(row.material(), row["R_over_R0"], row["delta_over_R0"], row["cA_over_pi_R02"]),
                   k_round_off);
    expect_shape(row, shape_of(row));
    row.expect("delta_1D_over_R0", 0.5 * shape_of(row).height, k_round_off);
  }
}

TEST(MdrPointValues, UnloadingContactIsMet) {
  const auto rows = rows_without_adhesion("pu");
  ASSERT_EQ(rows.size(), 5u);
  for (const Row& row : rows) {
    const UnloadingShape shape = shape_of(row);
    expect_shape(row, shape);
    const double u = unloading_fraction(shape, row["delta_over_R0"]);
    // The file's decimal overlaps are not doubles: their round-off moves u by up to eps times their ratio to the
    // recovery, and the force by 2.3 times as much (E/Y = 1e5: 7e-12).
    const double tolerance = k_round_off + 2.5 * k_epsilon * shape.overlap_max / shape.recovery;
    row.expect("delta_1D_over_R0", 0.5 * shape.height * (1.0 - u), tolerance);
    const Contact contact = unloading_contact(shape, row.material().composite_modulus, row["delta_over_R0"]);
    expect_contact(row, contact, tolerance);
    if (contact.force > 0.0) row.expect("F_deltamax_over_ER0", contact.by_overlap_max, tolerance);
  }
}

}  // namespace
}  // namespace monograin::mdr::point_values_test
