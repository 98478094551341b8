// Places weighed against each other, and a second look at the one that is followed.
#include "client/localize/place.h"

#include <gtest/gtest.h>

#include <cmath>

#include "client/localize/second_look.h"
#include "tests/client/fetch/held_segment.h"

namespace milepost {
namespace {

constexpr double kMetresOfADegree = 111229;  // of latitude, here

RouteLine northwards() {
  std::vector<GeoPoint> vertices;
  for (int i = 0; i <= 10; ++i) vertices.push_back({49.0 + 10 * i / kMetresOfADegree, 8.4, 110});
  return *RouteLine::from_vertices(vertices);
}

// Stands where it was put.
class Standing : public Follower {
 public:
  explicit Standing(double along_m) : along_m_(along_m) {}
  TrackedPosition position_at(double) const override { return position(); }
  AlongRange needed(double) const override { return {along_m_, along_m_}; }
  Followed follow(SeenFrame&) override { return {}; }
  TrackedPosition position() const override { return {along_m_, 0.1}; }
  std::optional<LearnedCamera> learned_camera() const override {
    return LearnedCamera{{0.05, 0, 0}, Eigen::Matrix3d::Identity()};
  }

 private:
  double along_m_;
};

class Places : public ::testing::Test {
 protected:
  Place place(double along_m, int matches, double log_bayes_factor, double odds = 0) const {
    Place place{segment_,
                std::make_unique<Standing>(along_m),
                PlaceOdds(PlaceOddsSettings()),
                ReceiverEvidence(ReceiverEvidenceSettings()),
                10,
                true,
                log_bayes_factor,
                matches};
    place.odds.add(odds);
    return place;
  }

  static Sighting sighting(double along_m, int matches) {
    return {std::make_unique<Standing>(along_m), matches, 5};
  }

  static double along_m(const Place& place) { return place.follower->position().along_m; }

  template <class... Each>
  static std::vector<Place> places(Each... each) {
    std::vector<Place> all;
    (all.push_back(std::move(each)), ...);
    return all;
  }

  std::shared_ptr<OpenSegment> segment_ = std::make_shared<OpenSegment>(
      OpenSegment{testing::layer_of({{}, "s"}, northwards(), {}, {}), nullptr});
};

TEST_F(Places, OfPlacesThatAreOneThePoseThatMostAgreesWithStays) {
  auto all = places(place(20.4, 90, 9, 3), place(20, 150, 5), place(60, 80, 4, 1));
  weigh(all, std::nullopt, 5);
  ASSERT_EQ(all.size(), 2U);
  EXPECT_EQ(along_m(all[0]), 20);
  EXPECT_GT(all[0].odds.log(), 3);  // those of the likelier
  EXPECT_EQ(all[0].log_bayes_factor, 9);
  EXPECT_EQ(along_m(all[1]), 60);
}

TEST_F(Places, APoseThatAlmostAsMuchAgreesWithMakesAPlaceUncertain) {
  auto all = places(place(21.5, 100, 5), place(20, 150, 5));
  weigh(all, std::nullopt, 5);
  EXPECT_NEAR(all.front().apart_m, 1.5, 0.01);
  all = places(place(21.5, 80, 5), place(20, 150, 5));
  weigh(all, std::nullopt, 5);
  EXPECT_EQ(all.front().apart_m, 0);
}

TEST_F(Places, OnlySoManyAndNoneThatIsUnlikelyArePursued) {
  auto all =
      places(place(10, 9, 2, 1), place(30, 9, 2, 3), place(50, 9, 2, 2), place(70, 9, 0, -8));
  weigh(all, std::nullopt, 5);
  ASSERT_EQ(all.size(), 3U);
  weigh(all, std::nullopt, 2);
  ASSERT_EQ(all.size(), 2U);
  EXPECT_EQ(along_m(all[0]), 30);
  EXPECT_EQ(along_m(all[1]), 50);
}

TEST_F(Places, TheFirstIsWeighedAgainstTheOthersAndElsewhere) {
  auto all = places(place(10, 9, 0, 8));
  const double alone = log_odds_of_first(all);
  EXPECT_NEAR(alone, all.front().odds.log(), 1e-12);
  all.push_back(place(50, 9, 0, 8));
  EXPECT_NEAR(log_odds_of_first(all), -std::log(1 + std::exp(-alone)), 1e-9);
}

TEST_F(Places, BehindWhereOneWasLeftIsUnlikelySoonAfter) {
  const Place left = place(100, 90, 5);
  Place ahead = place(100.3, 90, 5);
  Place behind = place(97, 90, 5);
  ahead.timestamp_s = behind.timestamp_s = 10.2;
  EXPECT_GT(log_density_after(left, ahead), -1);
  EXPECT_LT(log_density_after(left, behind), -8);
  behind.timestamp_s = 13;  // it may have turned
  EXPECT_GT(log_density_after(left, behind), -1);
}

TEST_F(Places, ASecondLookThatAgreesChangesNothing) {
  SecondLook look;
  Place followed = place(20, 100, 5);
  // The same pose; one that less agrees with; one that is another place's.
  for (const auto& [seen_m, matches] : {std::pair{20.3, 130}, {22.0, 85}, {26.0, 130}}) {
    for (int turn = 0; turn < 2; ++turn) {
      std::vector<Sighting> seen;
      seen.push_back(sighting(seen_m, matches));
      look.compare(followed, std::move(seen));
      EXPECT_EQ(followed.apart_m, 0) << seen_m;
    }
  }
  look.compare(followed, {});
  EXPECT_EQ(along_m(followed), 20);
}

TEST_F(Places, WhereMoreAgreesTwiceInTurnTheBeliefBeginsAgain) {
  SecondLook look;
  Place followed = place(20, 100, 5);
  const auto against = [&] {
    std::vector<Sighting> seen;
    seen.push_back(sighting(21.4, 130));
    followed.apart_m = 0;
    look.compare(followed, std::move(seen));
  };
  against();
  EXPECT_NEAR(followed.apart_m, 1.4, 0.01);
  look.compare(followed, {});                // not in turn ...
  EXPECT_NEAR(followed.apart_m, 1.4, 0.01);  // ... but uncertain for a while
  against();
  EXPECT_EQ(along_m(followed), 20);
  against();
  EXPECT_EQ(along_m(followed), 21.4);
  EXPECT_EQ(followed.matches, 130);
  for (const double apart_m : {1.4, 1.4, 0.0}) {
    EXPECT_NEAR(followed.apart_m, 1.4, 0.01);  // it tells so
    look.compare(followed, {});
    EXPECT_NEAR(followed.apart_m, apart_m, 0.01);
  }
}

TEST_F(Places, WhereAboutAsMuchAgreesThePlaceIsUncertainAndStays) {
  SecondLook look;
  Place followed = place(20, 100, 5);
  for (int turn = 0; turn < 3; ++turn) {
    std::vector<Sighting> seen;
    seen.push_back(sighting(22, 105));
    look.compare(followed, std::move(seen));
    EXPECT_NEAR(followed.apart_m, 2, 0.01);
  }
  EXPECT_EQ(along_m(followed), 20);
}

TEST_F(Places, SecondLooksAreOftenAtFirst) {
  SecondLook look;
  Place followed = place(20, 100, 5);
  for (int frame = 0; frame < 10; ++frame) {
    EXPECT_TRUE(look.is_due(20)) << frame;
    look.compare(followed, {});
  }
  EXPECT_FALSE(look.is_due(24.9));
  EXPECT_TRUE(look.is_due(25));
  std::vector<Sighting> against;
  against.push_back(sighting(22, 130));
  look.compare(followed, std::move(against));
  EXPECT_TRUE(look.is_due(20.1));
}

// What a belief that may have slipped learned of the camera is no help to find that out.
TEST_F(Places, SecondLooksBelieveTheCameraOnceThePoseIsCertain) {
  SecondLook look;
  Place followed = place(20, 100, 5);
  for (int frame = 0; frame < 10; ++frame) {
    EXPECT_FALSE(look.camera(followed)) << frame;
    look.compare(followed, {});
  }
  ASSERT_TRUE(look.camera(followed));
  EXPECT_EQ(look.camera(followed)->mean[0], 0.05);
  std::vector<Sighting> rival;
  rival.push_back(sighting(22, 105));
  look.compare(followed, std::move(rival));
  EXPECT_FALSE(look.camera(followed));
  for (int calm = 0; calm < 3; ++calm) look.compare(followed, {});
  EXPECT_TRUE(look.camera(followed));
}

}  // namespace
}  // namespace milepost
