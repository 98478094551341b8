#include "mapper/import/ros_topics.h"

#include <algorithm>
#include <map>

#include "mapper/import/ros/messages.h"
#include "mapper/import/what_names.h"

namespace milepost {
namespace {

using Topics = std::vector<ros::BagTopic>;
using Types = std::vector<std::string>;
using Choice = std::optional<std::size_t>;

constexpr const char* kNone = "none";

std::string joined(const std::vector<std::string>& words, const std::string& between) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : between) + word;
  return text;
}

std::vector<std::size_t> of_types(const Topics& topics, const Types& types) {
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < topics.size(); ++i)
    if (std::ranges::find(types, topics[i].type) != types.end()) found.push_back(i);
  return found;
}

std::string listed(const Topics& topics, const std::vector<std::size_t>& these) {
  std::vector<std::string> names;
  names.reserve(these.size());
  for (const std::size_t i : these) names.push_back(topics[i].name + " (" + topics[i].type + ")");
  return joined(names, ", ");
}

class TopicChoice {
 public:
  TopicChoice(const Topics& topics, const std::string& bag,
              const std::map<std::string, std::string>& names)
      : topics_(topics), bag_(bag), names_(names) {}

  bool is_named(const std::string& what) const { return names_.contains(what); }
  bool is_unwanted(const std::string& what) const {
    const auto name = names_.find(what);
    return name != names_.end() && name->second == kNone;
  }

  // The topic that the user names. REQUIRES: is_named(what).
  Result<Choice> named(const std::string& what, const Types& types) const {
    const std::vector<std::size_t> candidates = of_types(topics_, types);
    const std::string& name = names_.at(what);
    for (const std::size_t i : candidates)
      if (topics_[i].name == name) return Choice(i);
    return Error{ErrorCode::invalid_input, bag_,
                 "has no topic '" + name + "' of " + joined(types, " or "),
                 candidates.empty() ? "it has no topic of this kind"
                                    : "it has " + listed(topics_, candidates)};
  }

  // The only one, if there is one.
  Result<Choice> only(const std::string& what, const Types& types) const {
    const std::vector<std::size_t> candidates = of_types(topics_, types);
    if (candidates.empty()) return Choice();
    if (candidates.size() == 1) return Choice(candidates.front());
    return Error{ErrorCode::invalid_input, bag_,
                 "has several topics of this kind: " + listed(topics_, candidates),
                 "choose one with --topics " + what + "=NAME"};
  }

  Result<Choice> named_or_only(const std::string& what, const Types& types) const {
    return is_named(what) ? named(what, types) : only(what, types);
  }

  Error none(const Types& types) const {
    return {ErrorCode::invalid_input, bag_, "has no topic of " + joined(types, " or "),
            "name a bag with images and positions"};
  }

 private:
  const Topics& topics_;
  const std::string& bag_;
  const std::map<std::string, std::string>& names_;
};

Result<Choice> position_topic(const TopicChoice& choice) {
  if (choice.is_named("position"))
    return choice.named("position", {ros::kNavSatFix, ros::kOdometry});
  auto receiver = choice.only("position", {ros::kNavSatFix});
  if (!receiver || *receiver) return receiver;
  return choice.only("position", {ros::kOdometry});
}

Result<Choice> orientation_topic(const TopicChoice& choice, const Topics& topics,
                                 std::size_t position) {
  if (choice.is_unwanted("orientation")) return Choice();
  if (!choice.is_named("orientation") && topics[position].type == ros::kOdometry)
    return Choice(position);
  return choice.named_or_only("orientation", {ros::kOdometry, ros::kImu});
}

// The name without what transports add to it.
std::string raw_name(const std::string& image_topic) {
  constexpr std::string_view kTransport = "/compressed";
  if (!image_topic.ends_with(kTransport)) return image_topic;
  return image_topic.substr(0, image_topic.size() - kTransport.size());
}

Result<Choice> camera_info_topic(const TopicChoice& choice, const Topics& topics,
                                 const std::string& image_topic) {
  if (choice.is_unwanted("camera_info")) return Choice();
  if (!choice.is_named("camera_info")) {
    const std::string raw = raw_name(image_topic);
    const std::string beside = raw.substr(0, raw.rfind('/') + 1) + "camera_info";
    for (const std::size_t i : of_types(topics, {ros::kCameraInfo}))
      if (topics[i].name == beside) return Choice(i);
  }
  return choice.named_or_only("camera_info", {ros::kCameraInfo});
}

}  // namespace

bool is_rectified(const std::string& image_topic) {
  const std::string raw = raw_name(image_topic);
  return raw.substr(raw.rfind('/') + 1).starts_with("image_rect");
}

Result<RosTopics> ros_topics(const Topics& topics, const ImportOptions& options) {
  const auto names = names_by_what("--topics", options.topics,
                                   {"image", "camera_info", "position", "orientation"});
  if (!names) return names.error();
  const std::string bag = options.trajectory.string();
  const TopicChoice choice(topics, bag, *names);
  const Types images = {ros::kImage, ros::kCompressedImage};
  const auto image = choice.named_or_only("image", images);
  if (!image) return image.error();
  if (!*image) return choice.none(images);
  const auto position = position_topic(choice);
  if (!position) return position.error();
  if (!*position) return choice.none({ros::kNavSatFix, ros::kOdometry});
  const auto orientation = orientation_topic(choice, topics, **position);
  if (!orientation) return orientation.error();
  RosTopics chosen{**image, **position, *orientation, choice.is_named("orientation"), {}};
  if (options.has_camera) return chosen;
  const auto camera_info = camera_info_topic(choice, topics, topics[chosen.image].name);
  if (!camera_info) return camera_info.error();
  chosen.camera_info = *camera_info;
  return chosen;
}

}  // namespace milepost
