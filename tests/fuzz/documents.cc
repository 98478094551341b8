// The JSON documents that the client reads, from a server or from its cache. The first byte
// chooses which.
#include "client/fetch/documents.h"

#include <cstdint>
#include <string>
#include <string_view>

#include "schema/base/json.h"
#include "schema/document/manifest.h"
#include "schema/document/mapping_record.h"
#include "schema/document/signature.h"
#include "schema/feature/pca_projection.h"
#include "schema/feature/types.h"
#include "tests/fuzz/check.h"

namespace {

using namespace milepost;

const MapVersion kVersion{"town", "00112233445566778899aabbccddeeff"};

// What is read is written again as the same.
void read_manifest(std::string_view text) {
  const Result<Manifest> manifest = manifest_from(text);
  if (!manifest) return;
  const std::string written = manifest_document(*manifest);
  fuzz::check(manifest_document(*manifest_from(written)) == written);
}

void read_mapping_record(std::string_view text) {
  const Result<MappingRecord> record = mapping_record_from(text);
  if (!record) return;
  const std::string written = mapping_document(*record);
  fuzz::check(mapping_document(*mapping_record_from(written)) == written);
}

// Only the form that is written is read, and by no key that did not sign.
void read_signature(std::string_view text) {
  static const SecretKey kKey(SecretKey::Seed{1});
  static const SecretKey kOtherKey(SecretKey::Seed{2});
  const Result<Signature> signature = signature_from(text);
  if (!signature) return;
  fuzz::check(!signature->is_by(kOtherKey.public_key()));
  if (!signature->is_by(kKey.public_key())) return;
  fuzz::check(signature_text(signature->about, kKey) == text);
}

void read_key(std::string_view text) {
  const Result<PublicKey> open = public_key_from(text);
  if (open) fuzz::check(public_key_from(open->text())->bytes == open->bytes);
  const Result<SecretKey> secret = secret_key_from(text);
  if (secret) fuzz::check(secret_key_from(secret->text())->text() == secret->text());
}

// With the parameters of its features and layers.
void read_map(std::string_view text) {
  const Result<MapDescription> map = parse_map_document(text, "fuzz", kVersion);
  if (!map) return;
  for (const auto& [name, parameters] : map->layers) fuzz::check(!name.empty());
}

void read_segment(std::string_view text) {
  const Result<SegmentDocument> segment = parse_segment_document(text, "fuzz", kVersion, "s1");
  if (!segment) return;
  for (const auto& [layer, index] : segment->tiles) {
    fuzz::check(entries_meeting(index, {-1e8, 1e8}).size() == index.size());
  }
}

void read_areas(std::string_view text) {
  const Result<AreasDocument> areas = parse_areas_document(text, "fuzz");
  if (!areas) return;
  for (const auto& [layer, index] : *areas) {
    fuzz::check(entries_meeting(index, {-180, -90, 180, 90}).size() == index.size());
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::string_view text(reinterpret_cast<const char*>(data) + 1, size - 1);
  const Result<nlohmann::json> json = read_json(text);
  switch (data[0]) {
    case 'c':
      static_cast<void>(parse_catalog_document(text, "fuzz"));
      break;
    case 'n':
      static_cast<void>(parse_nearby_document(text, "fuzz"));
      break;
    case 't':
      static_cast<void>(is_of_static_store(text));
      static_cast<void>(parse_placed_segments(text, "fuzz"));
      break;
    case 'g':
      read_signature(text);
      break;
    case 'k':
      read_key(text);
      break;
    case 'm':
      read_map(text);
      break;
    case 'd':
      read_manifest(text);
      break;
    case 'p':
      read_mapping_record(text);
      break;
    case 's':
      read_segment(text);
      break;
    case 'a':
      read_areas(text);
      break;
    case 'f':
      if (json) static_cast<void>(feature_parameters_from_json(*json));
      break;
    case 'b':
      if (json) static_cast<void>(PcaProjection::from_json(*json));
      break;
    default:
      break;
  }
  return 0;
}
