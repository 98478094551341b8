#include "client/fetch/prefetcher.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <condition_variable>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

namespace milepost::testing {
namespace {

using ::testing::ElementsAre;

// Answers tiles() only when it may, and remembers what was asked for.
class HeldSource : public MapSource {
 public:
  Result<std::vector<TileFrame>> tiles(const MapVersion&, const std::string& segment,
                                       const std::string&, const AlongRange& range) override {
    std::unique_lock lock(mutex_);
    asked_m_.push_back(range.from_m);
    changed_.notify_all();
    changed_.wait(lock, [this] { return !held_; });
    if (segment == "bad") return Error{ErrorCode::unavailable, "the server", "is away", ""};
    return std::vector<TileFrame>{};
  }
  Result<std::vector<NearbySegment>> segments_near(const GeoPoint&, double) override {
    return std::vector<NearbySegment>{};
  }
  Result<std::vector<MapVersion>> maps() override { return std::vector<MapVersion>{}; }
  Result<MapDescription> describe(const MapVersion&) override { return MapDescription{}; }
  Result<SegmentDescription> segment(const MapVersion&, const std::string&) override {
    return SegmentDescription{};
  }
  Result<std::vector<CellFrame>> cells(const MapVersion&, const std::string&,
                                       const Bounds&) override {
    return std::vector<CellFrame>{};
  }
  Result<std::uint64_t> layer_bytes(const MapVersion&, const std::string&,
                                    const std::string&) override {
    return std::uint64_t{0};
  }
  SourceCounters counters() const override { return {}; }

  void hold(bool held) {
    const std::lock_guard lock(mutex_);
    held_ = held;
    changed_.notify_all();
  }
  void wait_until_asked(std::size_t times) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return asked_m_.size() >= times; });
  }
  std::vector<double> asked_m() {
    const std::lock_guard lock(mutex_);
    return asked_m_;
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  bool held_ = false;
  std::vector<double> asked_m_;
};

class PrefetcherTest : public ::testing::Test {
 protected:
  void request(Prefetcher& prefetcher, double from_m, const std::string& segment = "s1") {
    prefetcher.request({"town", "build"}, segment, "tracklets", {from_m, from_m + 100});
  }

  std::shared_ptr<HeldSource> source_ = std::make_shared<HeldSource>();
};

TEST_F(PrefetcherTest, AsksForWhatIsRequested) {
  Prefetcher prefetcher(source_);
  request(prefetcher, 10);
  prefetcher.wait_idle();
  EXPECT_THAT(source_->asked_m(), ElementsAre(10));
  EXPECT_FALSE(prefetcher.last_error().has_value());
}

TEST_F(PrefetcherTest, TheNewestRequestReplacesOneThatHasNotBegun) {
  Prefetcher prefetcher(source_);
  source_->hold(true);
  request(prefetcher, 10);
  source_->wait_until_asked(1);  // 10 is under way
  request(prefetcher, 20);
  request(prefetcher, 30);
  request(prefetcher, 40);
  source_->hold(false);
  prefetcher.wait_idle();
  EXPECT_THAT(source_->asked_m(), ElementsAre(10, 40));
}

TEST_F(PrefetcherTest, WaitingWithNothingToDoReturns) {
  Prefetcher prefetcher(source_);
  prefetcher.wait_idle();
  EXPECT_TRUE(source_->asked_m().empty());
}

TEST_F(PrefetcherTest, AFailureIsKept) {
  Prefetcher prefetcher(source_);
  request(prefetcher, 10, "bad");
  prefetcher.wait_idle();
  ASSERT_TRUE(prefetcher.last_error().has_value());
  EXPECT_EQ(prefetcher.last_error()->line(), "the server: is away");
  request(prefetcher, 20);  // goes on after it
  prefetcher.wait_idle();
  EXPECT_THAT(source_->asked_m(), ElementsAre(10, 20));
}

TEST_F(PrefetcherTest, EndsAfterWhatIsUnderWay) {
  auto prefetcher = std::make_unique<Prefetcher>(source_);
  source_->hold(true);
  request(*prefetcher, 10);
  source_->wait_until_asked(1);
  std::thread ending([&] { prefetcher.reset(); });
  source_->hold(false);
  ending.join();
  EXPECT_THAT(source_->asked_m(), ElementsAre(10));
}

}  // namespace
}  // namespace milepost::testing
