#include "history/table_file.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <bit>
#include <cerrno>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <limits>
#include <random>
#include <stdexcept>

#include "support/refusal.hpp"
#include "support/temporary_folder.hpp"
#include "support/text_file.hpp"

namespace {

off_t bytes_of_disk = std::numeric_limits<off_t>::max();  // beyond them, files that have a name cannot be written

}  // namespace

/// Takes the place of the system's function in libraries that this program loads.
extern "C" ssize_t pwrite(int file, const void* bytes, std::size_t count, off_t offset) {
  struct stat status {};
  if (fstat(file, &status) == 0 && status.st_nlink > 0 && offset + static_cast<off_t>(count) > bytes_of_disk) {
    errno = ENOSPC;
    return -1;
  }
  return syscall(SYS_pwrite64, file, bytes, count, offset);
}

namespace monograin::table_file_test {
namespace {

namespace fs = std::filesystem;

class Hdf5File : public ::testing::Test {
 protected:
  [[nodiscard]] fs::path file() const { return folder_.path() / "table.h5"; }
  [[nodiscard]] fs::path path(const std::string& name) const { return folder_.path() / name; }

  void write(const std::string& csv, std::size_t free_bytes = 0) const {
    const TableLines lines = [&csv](const TextSink& sink) {
      for (std::string_view rest = csv; !rest.empty();) {
        const std::size_t end = rest.find('\n');
        sink(rest.substr(0, end));
        rest.remove_prefix(end + 1);
      }
    };
    const auto group_of = [](const Column& column) { return column.unit.empty() ? std::string() : "numbers"; };
    write_hdf5(file(), {.free_bytes = free_bytes, .attributes = {{"title", "made"}}, .group_of = group_of}, lines);
  }

  [[nodiscard]] Table round_trip(const std::string& csv) const {
    write(csv);
    return read_table_file(file());
  }

  [[nodiscard]] std::string fault_of(const std::string& name) const {
    return refusal<std::runtime_error>([&] { return read_table_file(path(name)); });
  }

 private:
  TemporaryFolder folder_;
};

TEST_F(Hdf5File, RestoresNumbersBitByBit) {
  std::mt19937_64 random(3);
  std::string csv = "a[N],b[-]\n";
  std::vector<double> written{0.0,
                              -0.0,
                              std::numeric_limits<double>::denorm_min(),
                              std::numeric_limits<double>::max(),
                              std::numeric_limits<double>::infinity(),
                              1.0 / 3.0};
  // More than two chunks, the last of them not full.
  while (written.size() < 40'000) written.push_back(std::bit_cast<double>(random()));
  for (const double value : written) csv += fmt::format("{},{}\n", csv_number(value), csv_number(-value));
  const Table table = round_trip(csv);
  ASSERT_EQ(table.row_count(), written.size());
  for (std::size_t row = 0; row < written.size(); ++row) {
    const bool is_nan = std::isnan(written[row]);
    if (is_nan) {
      ASSERT_TRUE(std::isnan(table.at(row, 0))) << row;
    } else {
      ASSERT_EQ(std::bit_cast<std::uint64_t>(table.at(row, 0)), std::bit_cast<std::uint64_t>(written[row])) << row;
      ASSERT_EQ(std::bit_cast<std::uint64_t>(table.at(row, 1)), std::bit_cast<std::uint64_t>(-written[row])) << row;
    }
  }
}

TEST_F(Hdf5File, HasTheColumnsOfTheSameTableAsCsv) {
  const std::string csv =
      "run,state,reason,d(axial.force)/d(radius)[N/m],b[Pa],empty,gaps\n1,open,,1.5,nan,,\n"
      "2,K\u00f6rper,late; so,2,,,3\n";
  write_text(path("table.csv"), csv);
  const Table expected = read_table_file(path("table.csv"));
  const Table table = round_trip(csv);
  EXPECT_EQ(csv_text(table), csv_text(expected));
  EXPECT_EQ(table.columns(), expected.columns());
}

TEST_F(Hdf5File, MayHaveNoRows) {
  const Table table = round_trip("run[-],state\n");
  EXPECT_EQ(table.row_count(), 0U);
  EXPECT_EQ(table.columns().size(), 2U);
}

TEST_F(Hdf5File, LeavesRoomForAHeader) {
  write("a[N]\n1\n", 1024);
  std::fstream stream(file(), std::ios::in | std::ios::out | std::ios::binary);
  stream << "# title: first\n# of: two\n";
  stream.close();
  const Table table = read_hdf5(file());
  EXPECT_EQ(table.header_value("of"), "two");
  EXPECT_EQ(table.at(0, 0), 1.0);
}

#ifndef __SANITIZE_ADDRESS__  // the sanitizer keeps freed memory
/// Largest memory of this process [KiB] since the last call; 0 if it is unknown.
std::size_t peak_memory() {
  std::size_t peak = 0;
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    if (line.starts_with("VmHWM:")) peak = std::stoul(line.substr(6));
  }
  std::ofstream clear("/proc/self/clear_refs");
  clear << 5 << std::flush;
  return clear ? peak : 0;
}

TEST_F(Hdf5File, IsWrittenInTheSameMemoryForAnyNumberOfRows) {
  std::string headings = "run";
  std::string row = "1";
  for (int column = 0; column < 20; ++column) {
    headings += fmt::format(",{}[N]", column);
    row += fmt::format(",{}", std::sin(column));
  }
  const auto peak_of = [&](int rows) {
    peak_memory();
    write_hdf5(file(), {.group_of = [](const Column&) { return std::string(); }}, [&](const TextSink& sink) {
      sink(headings);
      for (int k = 0; k < rows; ++k) sink(row);
    });
    return peak_memory();
  };
  ASSERT_GT(peak_of(20'000), 0U);
  const std::size_t few = peak_of(20'000);
  const std::size_t many = peak_of(200'000);  // 34 MB of numbers
  ASSERT_GT(many, 0U);
  EXPECT_LT(many, few + 2048) << few << " KiB for a tenth of the rows";
}
#endif

/// A disk of a few bytes, for the time of this object.
class SmallDisk {
 public:
  explicit SmallDisk(off_t bytes) { bytes_of_disk = bytes; }
  ~SmallDisk() { bytes_of_disk = std::numeric_limits<off_t>::max(); }
  SmallDisk(const SmallDisk&) = delete;
  SmallDisk& operator=(const SmallDisk&) = delete;
};

TEST_F(Hdf5File, IsTheSameForTheSameLines) {
  write("a[N],b\n1,x\n");
  const std::string first = read_text(file());
  write("a[N],b\n1,x\n");
  EXPECT_EQ(read_text(file()), first);
}

TEST_F(Hdf5File, IsRefusedIfItIsNoTable) {
  write_text(path("text.h5"), "a[N]\n1\n");
  EXPECT_TRUE(contains(fault_of("text.h5"), "text.h5: cannot be read as a table in HDF5: "));
  EXPECT_TRUE(contains(fault_of("none.h5"), "No such file or directory")) << fault_of("none.h5");
  write("a[N]\n1\n");
  const std::string whole = read_text(file());
  write_text(path("cut.h5"), whole.substr(0, whole.size() / 2));
  EXPECT_TRUE(contains(fault_of("cut.h5"), "cut.h5: cannot be read")) << fault_of("cut.h5");
}

TEST_F(Hdf5File, IsNotWrittenFromLinesThatAreNoTable) {
  EXPECT_THROW(write("a[N],b[N]\n1,2\n3\n"), std::invalid_argument);
  EXPECT_THROW(write("a[N],b[N]\n1,word\n"), std::invalid_argument);
}

class Hdf5FileOnASmallDisk : public Hdf5File, public ::testing::WithParamInterface<off_t> {
 protected:
  Hdf5FileOnASmallDisk() {
    for (int row = 0; row < 40'000; ++row) csv_ += fmt::format("{},{}\n", std::sin(row), row % 7 == 0 ? "x" : "y");
  }

  [[nodiscard]] const std::string& csv() const { return csv_; }
  [[nodiscard]] std::string fault() const {
    const SmallDisk disk(GetParam());
    return refusal<std::runtime_error>([&] { return write(csv()), 0; });
  }

 private:
  std::string csv_ = "a[N],b\n";
};

TEST_P(Hdf5FileOnASmallDisk, IsAnErrorAfterWhichOthersCanBeWritten) {
  EXPECT_TRUE(contains(fault(), "table.h5: cannot be written: No space left on device")) << fault();
  EXPECT_EQ(round_trip(csv()).row_count(), 40'000U);
}

TEST_P(Hdf5FileOnASmallDisk, DoesNotDisturbTheEndOfTheProcess) {
  const auto fail_and_exit = [&] {
    EXPECT_NE(fault(), "");
    std::exit(0);
  };
  EXPECT_EXIT(fail_and_exit(), ::testing::ExitedWithCode(0), "^$");
}

INSTANTIATE_TEST_SUITE_P(OfBytes, Hdf5FileOnASmallDisk, ::testing::Values(0, 100, 10'000, 200'000));

TEST_F(Hdf5File, ThatCannotBeWrittenNamesTheReason) {
  const auto write_to_missing_folder = [this] {
    write_hdf5(path("no/folder.h5"), {.group_of = [](const Column&) { return std::string(); }},
               [](const TextSink& sink) { sink("a[N]"); });
    return 0;
  };
  const std::string message = refusal<std::runtime_error>(write_to_missing_folder);
  EXPECT_TRUE(contains(message, "folder.h5: cannot be written: No such file or directory")) << message;
}

}  // namespace
}  // namespace monograin::table_file_test
