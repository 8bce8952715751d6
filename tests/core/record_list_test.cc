#include <gtest/gtest.h>

#include "tests/core/input_error.h"
#include "tests/core/refusals.h"
#include "twin/core/schema_table.h"
#include "twin/core/toml_reader.h"

namespace twinbench {
namespace {

/// One entry of the list.
struct Place {
  std::string what = "bar";
  double at_m = 0.5;
  int turns = 2;
};

void AddPlace(schema::Table& table, Place& place) {
  table.Text("what", &place.what, {"bar", "grid"}, "");
  table.Add("at", schema::kMm, schema::UpTo(1000), &place.at_m, "");
  table.Add("turns", schema::kPure, {1, 9}, &place.turns, "");
}

std::vector<Place> ReadPlaces(const std::string& text) {
  std::vector<Place> places = {{}};
  schema::Keys keys;
  schema::Table(keys, "run").Records("places", places, AddPlace, "");
  ReadToml(text, "s.toml", keys);
  return places;
}

std::string RecordError(const std::string& text) {
  return MessageOf([&] { ReadPlaces(text); });
}

TEST(RecordList, IsReplacedAsAWholeAndWhatATableLeavesOutKeepsItsDefault) {
  const std::vector<Place> places =
      ReadPlaces("[run]\nplaces = [{ what = \"grid\", at_mm = 60 }, { turns = 3 }]\n");
  ASSERT_EQ(places.size(), 2u);
  EXPECT_EQ(places[0].what, "grid");
  EXPECT_EQ(places[0].at_m, 0.060);
  EXPECT_EQ(places[0].turns, 2);
  EXPECT_EQ(places[1].what, "bar");
  EXPECT_EQ(places[1].at_m, 0.5);
  EXPECT_EQ(places[1].turns, 3);
  EXPECT_EQ(ReadPlaces("").size(), 1u);
}

TEST(RecordList, SaysWhatIsWrongInsideATable) {
  for (const char* places : {"[{ at = 60 }]", "[{ at_mm = 2000 }]", "[{ what = \"ball\" }]", "[7]", "[]"})
    ExpectRefused("s.toml", RecordError, {{2, "[run]\nplaces = " + std::string(places) + "\n"}});
}

}  // namespace
}  // namespace twinbench
