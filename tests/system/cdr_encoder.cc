// Encodes messages as CDR by another implementation than the mapper's, eProsima's.
// usage: cdr-encoder little|big
// Standard input: a message a line, of fields TYPE:VALUE separated by blanks; text without blanks,
// sequences with commas, bytes in hexadecimal. Standard output: the length of each message as 32
// bits, in this machine's order, and the message.
#include <fastcdr/Cdr.h>
#include <fastcdr/FastBuffer.h>

#include <cstdint>
#include <cstdlib>
#include <functional>
#include <iostream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

namespace {

using eprosima::fastcdr::Cdr;

std::vector<double> doubles_in(const std::string& text) {
  std::vector<double> values;
  std::istringstream stream(text);
  for (std::string word; std::getline(stream, word, ',');) values.push_back(std::stod(word));
  return values;
}

std::vector<std::uint8_t> bytes_in(const std::string& text) {
  std::vector<std::uint8_t> bytes;
  for (std::size_t i = 0; i + 1 < text.size(); i += 2)
    bytes.push_back(static_cast<std::uint8_t>(std::stoul(text.substr(i, 2), nullptr, 16)));
  return bytes;
}

using Encode = std::function<void(Cdr&, const std::string&)>;

const std::map<std::string, Encode> kTypes = {
    {"i8", [](Cdr& cdr, const std::string& v) { cdr << static_cast<std::int8_t>(std::stoi(v)); }},
    {"u8", [](Cdr& cdr, const std::string& v) { cdr << static_cast<std::uint8_t>(std::stoi(v)); }},
    {"u16",
     [](Cdr& cdr, const std::string& v) { cdr << static_cast<std::uint16_t>(std::stoi(v)); }},
    {"i32", [](Cdr& cdr, const std::string& v) { cdr << static_cast<std::int32_t>(std::stol(v)); }},
    {"u32",
     [](Cdr& cdr, const std::string& v) { cdr << static_cast<std::uint32_t>(std::stoul(v)); }},
    {"f64", [](Cdr& cdr, const std::string& v) { cdr << std::stod(v); }},
    {"text", [](Cdr& cdr, const std::string& v) { cdr << v; }},
    {"f64s", [](Cdr& cdr, const std::string& v) { cdr << doubles_in(v); }},
    {"bytes", [](Cdr& cdr, const std::string& v) { cdr << bytes_in(v); }},
};

}  // namespace

int main(int argc, char** argv) {
  const bool is_big = argc == 2 && std::string(argv[1]) == "big";
  for (std::string line; std::getline(std::cin, line);) {
    eprosima::fastcdr::FastBuffer buffer;
    Cdr cdr(buffer, is_big ? Cdr::BIG_ENDIANNESS : Cdr::LITTLE_ENDIANNESS, Cdr::DDS_CDR);
    cdr.serialize_encapsulation();
    std::istringstream fields(line);
    for (std::string field; fields >> field;) {
      const std::size_t colon = field.find(':');
      kTypes.at(field.substr(0, colon))(cdr, field.substr(colon + 1));
    }
    const auto length = static_cast<std::uint32_t>(cdr.getSerializedDataLength());
    std::cout.write(reinterpret_cast<const char*>(&length), sizeof(length));
    std::cout.write(buffer.getBuffer(), length);
  }
  return std::cout ? EXIT_SUCCESS : EXIT_FAILURE;
}
