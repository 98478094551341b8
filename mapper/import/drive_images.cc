#include "mapper/import/drive_images.h"

#include <algorithm>
#include <set>
#include <system_error>

namespace milepost {
namespace {

namespace fs = std::filesystem;

Status place_image(const fs::path& from, const fs::path& to, PlaceImages how) {
  std::error_code error;
  if (how == PlaceImages::copy) {
    fs::copy_file(from, to, error);
  } else if (how == PlaceImages::move) {
    fs::rename(from, to, error);
  } else {
    const fs::path absolute = fs::canonical(from, error);
    if (!error) fs::create_symlink(absolute, to, error);
  }
  if (!error) return ok_status();
  return Error{ErrorCode::io, from.string(), "cannot be taken over (" + error.message() + ")",
               "check the image and the drive's folder"};
}

Status make_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (!error) return ok_status();
  return Error{ErrorCode::io, folder.string(), "cannot be created (" + error.message() + ")",
               "check the path and the permissions"};
}

}  // namespace

std::vector<std::string> frame_names(const std::vector<RecordedImage>& images) {
  std::vector<std::string> names;
  std::set<std::string> known;
  bool are_plain = true;
  for (const RecordedImage& image : images) {
    names.push_back(image.file.filename().string());
    are_plain = are_plain && known.insert(names.back()).second &&
                names.back().find_first_of(",;\t\"") == std::string::npos;
  }
  if (are_plain) return names;
  for (std::size_t i = 0; i < images.size(); ++i) {
    std::string number = std::to_string(i);
    number.insert(0, 6 - std::min<std::size_t>(6, number.size()), '0');
    names[i] = number + images[i].file.extension().string();
  }
  return names;
}

Status place_images(const std::vector<RecordedImage>& images, const std::vector<std::string>& names,
                    ImageContainer* container, PlaceImages how, const fs::path& folder) {
  if (const Status made = make_folder(folder); !made) return made;
  for (std::size_t i = 0; i < images.size(); ++i) {
    const fs::path frame = folder / names[i];
    const Status placed = container == nullptr ? place_image(images[i].file, frame, how)
                                               : container->write(images[i], frame);
    if (!placed) return placed;
  }
  return ok_status();
}

Status extract_images(Recording& recording, const fs::path& folder) {
  const std::vector<std::string> names = frame_names(recording.images);
  const Status placed =
      place_images(recording.images, names, recording.container.get(), PlaceImages::move, folder);
  if (!placed) return placed;
  recording.container = nullptr;
  for (std::size_t i = 0; i < names.size(); ++i) recording.images[i].file = folder / names[i];
  return ok_status();
}

}  // namespace milepost
