// Moving vehicles during a recorded drive.
#pragma once

#include <vector>

#include "tests/simulator/motion.h"
#include "tests/simulator/render.h"
#include "tests/simulator/runs.h"
#include "tests/simulator/vehicle.h"

namespace milepost::simulator {

// Immutable, so safe to share between threads. Refers to a network, which must outlive it.
class Traffic {
 public:
  Traffic(const Network& network, const RunPlan& run);

  // The positions of the vehicles when the recording vehicle is at an arc length of its route.
  Moving at(double time_s, double along_m) const;

 private:
  struct Oncoming {
    Vehicle vehicle;
    double along_m;  // at time 0 of the run
    double speed_mps;
  };

  void place(Moving& moving, const Vehicle& vehicle, double along_m, double lateral_m,
             double towards) const;

  const Network& network_;
  const Route& route_;
  const Path path_;
  double start_s_;
  std::uint64_t seed_;
  std::vector<Vehicle> trucks_;  // one or none
  std::vector<Oncoming> oncoming_;
};

}  // namespace milepost::simulator
