// What the localizer may be told to do otherwise.
#pragma once

#include "client/fetch/provider_state.h"
#include "client/localize/gnss_likelihood.h"
#include "client/localize/landmark_method.h"
#include "client/localize/log_odds.h"
#include "client/localize/method.h"

namespace milepost {

struct LocalizerSettings {
  Method method = landmark_method();
  double start_radius_m = 30;  // segments farther from the GNSS fix are not searched
  double start_sigmas = 3;     // of the GNSS fix, searched along the segment
  double start_reach_m = 5;    // ... plus this
  double max_gnss_age_s = 3;   // older fixes neither start nor contradict a hypothesis
  LogOddsSettings odds;
  GnssLikelihoodSettings receiver;
  int max_hypotheses = 5;        // tested against each other
  int max_predicted_frames = 8;  // without a measurement, until other hypotheses are searched
  double prefetch_m = 300;       // length of road to prefetch ahead
  MethodSettings method_settings;
  ProviderSettings provider;
};

}  // namespace milepost
