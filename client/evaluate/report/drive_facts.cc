#include "client/evaluate/report/drive_facts.h"

#include "schema/page/report_numbers.h"

namespace milepost {
namespace {

std::string frames_fact(const Drive& drive) {
  std::string text = std::to_string(drive.frames.size());
  if (drive.frames.size() > 1) {
    const double duration_s = drive.frames.back().timestamp_s - drive.frames.front().timestamp_s;
    text += " in " + number(duration_s, 1) + " s";
  }
  if (drive.camera.width_px > 0) {
    text += ", " + std::to_string(drive.camera.width_px) + " \u00D7 " +
            std::to_string(drive.camera.height_px) + " pixels";
  }
  return text;
}

}  // namespace

Facts facts_of(const Drive& drive) {
  return {{"Captured", drive.captured},
          {"Frames", frames_fact(drive)},
          {"Recording", drive.source},
          {"Licence", drive.licence}};
}

std::string title_of(const Drive& drive) {
  return drive.name.empty() ? "unnamed drive" : drive.name;
}

}  // namespace milepost
