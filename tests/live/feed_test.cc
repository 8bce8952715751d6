#include "tools/live/feed.h"

#include <gtest/gtest.h>

namespace twinbench::live {
namespace {

TEST(Feed, GivesWholeEventsOnceAndInOrder) {
  Feed feed(100);
  for (const char* json : {"1", "2", "3"}) feed.Add("reading", json);
  std::uint64_t next = 1;
  EXPECT_EQ(feed.From(next, 1), "id: 1\nevent: reading\ndata: 2\n\n");
  EXPECT_EQ(feed.From(next, 1000), "id: 2\nevent: reading\ndata: 3\n\n");
  EXPECT_EQ(feed.From(next, 1000), "");
  EXPECT_EQ(next, feed.end());
}

TEST(Feed, KeepsTheNewestAndGoesOnWithThem) {
  Feed feed(2);
  for (const char* json : {"1", "2", "3"}) feed.Add("reading", json);
  std::uint64_t next = 0;
  EXPECT_EQ(feed.From(next, 1000), "id: 1\nevent: reading\ndata: 2\n\nid: 2\nevent: reading\ndata: 3\n\n");
  EXPECT_EQ(next, 3u);
}

TEST(Feed, HasNothingForAPageThatIsAheadOfIt) {
  Feed feed(2);
  feed.Add("reading", "1");
  std::uint64_t next = 500;  // of a program that ran before at the same port
  EXPECT_EQ(feed.From(next, 1000), "");
}

}  // namespace
}  // namespace twinbench::live
