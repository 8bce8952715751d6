#include <regex>
#include <utility>

#include "tests/layers/source_files.h"

namespace twinbench {
namespace {

struct Include {
  std::string file, target;
};

/// A bench's folder holds five rooms: its text side, which core alone can link; how it is driven; its estimators,
/// which the twin is there to validate; its simulation, below twin/, of which all else sees only the header that
/// makes it; and what is done with its readings.
constexpr const char* kFormats = "twin/benches (text)";
constexpr const char* kProcedures = "twin/benches (procedure)";
constexpr const char* kEstimators = "twin/benches (estimators)";
constexpr const char* kTwins = "twin/benches (twin)";
constexpr const char* kFactories = "twin/benches (twin/factory.h)";

/// The room table: which of our rooms each may include, besides itself. No room's folder is in another's.
const std::map<std::string, std::set<std::string>> kMayInclude = {
    {"optics", {}},
    {"mechanics", {}},
    {"twin/core", {}},
    {"twin/import", {"twin/core"}},
    {"twin/plausible", {"twin/core"}},
    {"twin/model", {"twin/core"}},
    {"twin/sim", {"twin/core", "twin/model", "optics", "mechanics"}},
    {"twin/procedure", {"twin/core"}},
    {"twin/separate", {"twin/core"}},
    {"twin/uncertainty", {"twin/core", "twin/model"}},
    {"twin/diagnose", {"twin/core", "twin/model"}},
    {"twin/plan", {"twin/core", "twin/model", "twin/separate", "twin/uncertainty"}},
    {"twin/investigate", {"twin/core", "twin/model", "twin/uncertainty", "twin/diagnose", "twin/plan"}},
    {"twin/campaign",
     {"twin/core", "twin/procedure", "twin/uncertainty", "twin/diagnose", "twin/plan", "twin/report", "twin/benches"}},
    {"twin/report",
     {"twin/core", "twin/separate", "twin/uncertainty", "twin/diagnose", "twin/plan", "twin/investigate"}},
    {kFormats, {"twin/core"}},
    {kProcedures, {"twin/core", "twin/procedure", kFormats}},
    {kEstimators, {"twin/core", "twin/separate", kFormats}},
    {kFactories, {"twin/core", "twin/model"}},
    {kTwins,
     {"twin/core", "twin/model", "twin/sim", "twin/procedure", "optics", "mechanics", kFormats, kProcedures,
      kFactories}},
    {"twin/benches",
     {"twin/core", "twin/model", "twin/procedure", "twin/separate", "twin/uncertainty", "twin/plan",
      "twin/diagnose", "twin/plausible", "twin/report", kFormats, kProcedures, kEstimators, kFactories}},
    {"hw_bridge", {"twin/core"}}};

/// Third-party headers that only some rooms may see, by how their path begins.
const std::map<std::string, std::set<std::string>> kOwners = {
    {"embree", {"optics"}}, {"OpenEXR/", {"optics"}}, {"Imf", {"optics"}}, {"Imath", {"optics"}},
    {"BulletDynamics", {"mechanics"}}, {"LinearMath/", {"mechanics"}}, {"btBullet", {"mechanics"}},
    {"sqlite3", {"twin/core"}}, {"openssl/", {"twin/core"}}, {"toml++", {"twin/core"}}, {"mpi", {"twin/campaign"}}, {"asio", {"hw_bridge"}},
    {"iio", {"hw_bridge"}}, {"comedi", {"hw_bridge"}}, {"pugi", {"hw_bridge", "twin/report"}}};

std::string RoomOf(const std::string& path) {
  static const std::vector<std::pair<std::regex, const char*>> parts = {
      {std::regex(R"(twin/benches/((names|formats)|\w+/(format|settings|columns|effects))\.(h|cc))"), kFormats},
      {std::regex(R"(twin/benches/\w+/procedure(/\w+)?\.(h|cc))"), kProcedures},
      {std::regex(R"(twin/benches/\w+/estimators/.*)"), kEstimators},
      {std::regex(R"(twin/benches/\w+/twin/factory\.h)"), kFactories},
      {std::regex(R"(twin/benches/\w+/twin/.*)"), kTwins}};
  for (const auto& [pattern, room] : parts) {
    if (std::regex_match(path, pattern)) return room;
  }
  for (const auto& [room, allowed] : kMayInclude) {
    if (path.starts_with(room + "/")) return room;
  }
  return {};
}

std::vector<Include> ReadIncludes() {
  std::vector<Include> includes;
  const std::regex directive(R"(^\s*#\s*include\s*[<"]([^>"]+)[>"])");
  for (const std::string& file : FilesBelow({"optics", "mechanics", "twin", "hw_bridge"})) {
    std::smatch match;
    for (const std::string& line : LinesOf(file))
      if (line.find("include") != line.npos && std::regex_search(line, match, directive))
        includes.push_back({file, match[1]});
  }
  return includes;
}

const std::vector<Include>& AllIncludes() {
  static const std::vector<Include> includes = ReadIncludes();
  return includes;
}

TEST(Layers, EveryIncludeIsAllowedByTheRoomTableAndIncludesAreSeen) {
  const auto is_known = [](const Include& i) {
    return i.file == "twin/core/devices.h" && i.target == "twin/core/reading.h";
  };
  EXPECT_TRUE(std::ranges::any_of(AllIncludes(), is_known)) << "nothing was read";
  for (const Include& include : AllIncludes()) {
    const std::string from = RoomOf(include.file);
    ASSERT_FALSE(from.empty()) << include.file << " is in no room";
    const std::string to = RoomOf(include.target);
    if (to.empty() || to == from) continue;
    EXPECT_TRUE(kMayInclude.at(from).contains(to)) << include.file << " includes " << include.target;
  }
}

TEST(Layers, NoBenchIncludesAnother) {
  static const std::regex of_a_bench(R"(twin/benches/(\w+)/.*)");
  for (const Include& include : AllIncludes()) {
    std::smatch from, to;
    if (std::regex_match(include.file, from, of_a_bench) && std::regex_match(include.target, to, of_a_bench)) {
      EXPECT_EQ(from[1], to[1]) << include.file << " includes " << include.target;
    }
  }
}

TEST(Layers, ThirdPartyHeadersStayInTheRoomThatOwnsThem) {
  for (const Include& include : AllIncludes()) {
    for (const auto& [prefix, owners] : kOwners) {
      if (!include.target.starts_with(prefix)) continue;
      EXPECT_TRUE(owners.contains(RoomOf(include.file))) << include.file << " includes " << include.target;
    }
  }
}

TEST(Layers, EmbreeAndBulletStayOutOfHeaders) {
  for (const Include& include : AllIncludes()) {
    if (!include.file.ends_with(".h")) continue;
    for (const char* prefix : {"embree", "Bullet", "LinearMath/", "btBullet"}) {
      EXPECT_FALSE(include.target.starts_with(prefix)) << include.file << " includes " << include.target;
    }
  }
}

TEST(Layers, TheServerHasNoMeansToTouchFiles) {
  // No request of a client may read or write a file; what cannot open one cannot be made to.
  for (const std::string& file : FilesBelow({"hw_bridge/serve"})) {
    const std::string text = TextOf(file);
    for (const char* means :
         {"fstream", "filesystem", "fopen", "std::FILE", "popen", "system(", "dlopen", " ::open("})
      EXPECT_EQ(text.find(means), std::string::npos) << file << " has " << means;
  }
}

/// Rooms that may include none of those that are left are taken away until none is.
TEST(Layers, FoldersFormNoCircle) {
  auto rooms = kMayInclude;
  const auto includes_none = [&](const auto& room) {
    return std::ranges::none_of(room.second, [&](const std::string& other) { return rooms.contains(other); });
  };
  while (std::erase_if(rooms, includes_none) > 0) {
  }
  for (const auto& [room, others] : rooms) ADD_FAILURE() << "a circle of folders goes through " << room;
}

}  // namespace
}  // namespace twinbench
