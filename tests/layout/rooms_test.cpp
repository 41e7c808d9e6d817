// Which rooms include which: the part of the layering that no linker sees.

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace monograin::rooms_test {
namespace {

namespace fs = std::filesystem;

/// Rooms of src/ from left to right; those of a group know nothing of each other.
const std::vector<std::vector<std::string>> k_rooms{{"numerics"},
                                                    {"scenario"},
                                                    {"scene"},
                                                    {"engine"},
                                                    {"history"},
                                                    {"figure", "exchange"},
                                                    {"continuum"},
                                                    {"study/formula"},
                                                    {"study/sweep", "study/calibrate", "study/atlas"},
                                                    {"study/identify"},
                                                    {"api"},
                                                    {"verify/probe"},
                                                    {"verify/bench", "verify/regress", "verify/stress"},
                                                    {"cli"}};

/// Headers of models that rooms may include: they say what a model is, and list all.
const std::set<std::string> k_of_all_models{"catalogue.hpp", "contacts/centre/reaction_cone.hpp", "stress_test",
                                            "system"};

/// Group of the room that a file is in, and its name; the number of groups where it is in none.
std::pair<std::size_t, std::string> room_of(const std::string& path) {
  for (std::size_t group = 0; group < k_rooms.size(); ++group) {
    for (const std::string& room : k_rooms[group]) {
      if (path.starts_with(room + "/")) return {group, room};
    }
  }
  return {k_rooms.size(), {}};
}

std::vector<std::string> includes_of(const fs::path& file) {
  std::vector<std::string> included;
  std::ifstream stream(file);
  constexpr std::string_view k_begin = "#include \"";
  for (std::string line; std::getline(stream, line);) {
    if (line.starts_with(k_begin)) {
      included.push_back(line.substr(k_begin.size(), line.rfind('"') - k_begin.size()));
    }
  }
  return included;
}

template <class Visit>
void for_each_source(const std::string& folder, Visit visit) {
  const fs::path root = fs::path(MONOGRAIN_SOURCE_DIR) / folder;
  for (const auto& entry : fs::recursive_directory_iterator(root)) {
    const std::string extension = entry.path().extension().string();
    if (extension != ".hpp" && extension != ".cpp") continue;
    visit(fs::relative(entry.path(), root).string(), includes_of(entry.path()));
  }
}

TEST(Rooms, IncludeOnlyWhatIsOnTheirLeft) {
  std::size_t files = 0;
  for_each_source("src", [&](const std::string& file, const std::vector<std::string>& included) {
    ++files;
    const auto [group, room] = room_of(file);
    ASSERT_LT(group, k_rooms.size()) << file << " is in no room";
    for (const std::string& header : included) {
      const auto [other_group, other] = room_of(header);
      const std::string folder = header.substr(0, header.find('/'));
      const bool is_for_all =
          k_of_all_models.contains(folder) || k_of_all_models.contains(header) || folder == "monograin";
      EXPECT_TRUE(is_for_all || other == room || other_group < group) << file << " includes " << header;
    }
  });
  EXPECT_GT(files, 150U);
}

TEST(Rooms, ModelsIncludeOnlyModels) {
  for_each_source("models", [](const std::string& file, const std::vector<std::string>& included) {
    for (const std::string& header : included) {
      EXPECT_TRUE(fs::exists(fs::path(MONOGRAIN_SOURCE_DIR) / "models" / header)) << file << " includes " << header;
    }
  });
}

TEST(Rooms, FoldersOfModelsIncludeEachOtherInOneDirection) {
  const auto folder_of = [](const std::string& path) { return path.substr(0, path.find('/')); };
  std::map<std::string, std::set<std::string>> needed;
  for_each_source("models", [&](const std::string& file, const std::vector<std::string>& included) {
    std::set<std::string>& of_file = needed[folder_of(file)];
    for (const std::string& header : included) {
      if (folder_of(header) != folder_of(file)) of_file.insert(folder_of(header));
    }
  });
  // Folders that need none of the rest are taken away, again and again; a circle stays.
  const auto needs_none_left = [&](const auto& entry) {
    return std::ranges::none_of(entry.second, [&](const std::string& folder) { return needed.contains(folder); });
  };
  while (std::erase_if(needed, needs_none_left) > 0) continue;
  for (const auto& [folder, others] : needed) ADD_FAILURE() << "models/" << folder << " includes what includes it";
}

}  // namespace
}  // namespace monograin::rooms_test
