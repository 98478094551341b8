// JPEG (ITU T.81): checks that every coefficient of the image is present. They are read by the
// library that decodes them later; its warnings report missing data that it would fill in.
#include <csetjmp>
#include <cstdlib>
#include <memory>

#include "schema/drive/image_bytes.h"

// jpeglib.h requires the headers before it, and jerror.h requires jpeglib.h.
// clang-format off
#include <cstddef>
#include <cstdio>
#include <jpeglib.h>
#include <jerror.h>
// clang-format on

namespace milepost {
namespace {

// Cameras pad before the end marker. More bytes than this are coded data beyond the image's.
constexpr int kMostPadding = 16;
constexpr int kEndOfImage = 0xd9;
constexpr int kExif = JPEG_APP0 + 1;
constexpr unsigned kLongestMarker = 0xffff;

enum class JpegVerdict { whole, flawed, cut_short, damaged, for_print, not_decodable };

// Handlers that the library calls instead of writing to standard error and ending the program.
struct Complaints {
  jpeg_error_mgr manager{};  // first: the library passes a pointer to it
  std::jmp_buf out{};
  bool ran_out = false;  // of bytes, before the end marker
  bool flawed = false;
  JpegVerdict verdict = JpegVerdict::whole;  // if it ended the reading
};

Complaints& complaints_of(j_common_ptr codec) { return *reinterpret_cast<Complaints*>(codec->err); }

[[noreturn]] void end_reading(Complaints& complaints, JpegVerdict verdict) {
  complaints.verdict = verdict;
  std::longjmp(complaints.out, 1);  // NOLINT(cert-err52-cpp): through a C library
}

bool costs_no_pixel(const jpeg_error_mgr& manager) {
  switch (manager.msg_code) {
    case JWRN_JPEG_EOF:  // missing data is checked for later
    case JWRN_ADOBE_XFORM:
    case JWRN_BOGUS_ICC:
    case JWRN_JFIF_MAJOR:
    case JWRN_NOT_SEQUENTIAL:
      return true;
    case JWRN_EXTRANEOUS_DATA:
      return manager.msg_parm.i[1] == kEndOfImage && manager.msg_parm.i[0] <= kMostPadding;
    default:
      return false;
  }
}

void note_message(j_common_ptr codec, int level) {
  if (level >= 0) return;  // a trace
  Complaints& complaints = complaints_of(codec);
  complaints.flawed = true;
  if (complaints.manager.msg_code == JWRN_JPEG_EOF) complaints.ran_out = true;
  if (costs_no_pixel(complaints.manager)) return;
  const bool data_ended = complaints.ran_out || complaints.manager.msg_code == JWRN_HIT_MARKER;
  end_reading(complaints, data_ended ? JpegVerdict::cut_short : JpegVerdict::damaged);
}

void end_jpeg_with_error(j_common_ptr codec) {
  Complaints& complaints = complaints_of(codec);
  end_reading(complaints, complaints.ran_out ? JpegVerdict::cut_short : JpegVerdict::not_decodable);
}

void write_nothing(j_common_ptr /*codec*/) {}

void listen(Complaints& complaints) {
  jpeg_std_error(&complaints.manager);
  complaints.manager.emit_message = note_message;
  complaints.manager.error_exit = end_jpeg_with_error;
  complaints.manager.output_message = write_nothing;
}

// Whether the scans contained the whole image. An image without its end marker may lack whole
// scans, of a component or of the finer bits of a progressive image.
bool has_all_scans(const jpeg_decompress_struct& image, bool ran_out) {
  for (int c = 0; c < image.num_components; ++c) {
    if (image.comp_info[c].quant_table == nullptr) return false;  // set by its first scan
    if (!ran_out || image.coef_bits == nullptr) continue;
    for (int k = 0; k < DCTSIZE2; ++k) {
      if (image.coef_bits[c][k] != 0) return false;
    }
  }
  return true;
}

// A decompressor, and a compressor for a copy of its coefficients.
struct Codecs {
  Complaints complaints;
  jpeg_decompress_struct image{};
  jpeg_compress_struct copy{};
  unsigned char* written = nullptr;
  unsigned long written_size = 0;

  Codecs() {
    listen(complaints);
    image.err = &complaints.manager;
    copy.err = &complaints.manager;
  }
  ~Codecs() {
    jpeg_destroy_decompress(&image);
    jpeg_destroy_compress(&copy);
    std::free(written);  // NOLINT(cppcoreguidelines-no-malloc): the library allocates it
  }
  Codecs(const Codecs&) = delete;
  Codecs& operator=(const Codecs&) = delete;
};

// Writes the coefficients of a whole image to a new file, with the EXIF data, which holds the
// orientation.
void write_copy(Codecs& codecs, jvirt_barray_ptr* coefficients) {
  jpeg_create_compress(&codecs.copy);
  jpeg_mem_dest(&codecs.copy, &codecs.written, &codecs.written_size);
  jpeg_copy_critical_parameters(&codecs.image, &codecs.copy);
  codecs.copy.optimize_coding = TRUE;
  jpeg_write_coefficients(&codecs.copy, coefficients);
  for (const auto* marker = codecs.image.marker_list; marker != nullptr; marker = marker->next) {
    jpeg_write_marker(&codecs.copy, marker->marker, marker->data, marker->data_length);
  }
  jpeg_finish_compress(&codecs.copy);
}

// No local has a destructor: the library leaves by longjmp.
JpegVerdict read_jpeg(Codecs& codecs, const std::string& bytes) {
  if (setjmp(codecs.complaints.out) != 0) {  // NOLINT(cert-err52-cpp): a C library
    return codecs.complaints.verdict;
  }
  jpeg_create_decompress(&codecs.image);
  jpeg_mem_src(&codecs.image, reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size());
  jpeg_save_markers(&codecs.image, kExif, kLongestMarker);
  jpeg_read_header(&codecs.image, TRUE);
  constexpr int kColors = 3;
  if (codecs.image.num_components > kColors) return JpegVerdict::for_print;
  jvirt_barray_ptr* coefficients = jpeg_read_coefficients(&codecs.image);
  if (!has_all_scans(codecs.image, codecs.complaints.ran_out)) return JpegVerdict::cut_short;
  if (!codecs.complaints.flawed) return JpegVerdict::whole;
  write_copy(codecs, coefficients);
  return JpegVerdict::flawed;
}

}  // namespace

Result<std::string> sound_jpeg(std::string bytes) {
  const auto codecs = std::make_unique<Codecs>();
  switch (read_jpeg(*codecs, bytes)) {
    case JpegVerdict::whole:
      return bytes;
    case JpegVerdict::flawed:
      return std::string(reinterpret_cast<const char*>(codecs->written), codecs->written_size);
    case JpegVerdict::cut_short:
      return cut_short();
    case JpegVerdict::damaged:
      return damaged();
    case JpegVerdict::for_print:
      return Error{ErrorCode::invalid_input, "", "is a CMYK image, for print",
                   "write grey values, or red, green and blue"};
    case JpegVerdict::not_decodable:
      break;
  }
  return not_decodable();
}

}  // namespace milepost
