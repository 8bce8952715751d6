#include "hw_bridge/serve/iiod_attributes.h"

#include <algorithm>
#include <cerrno>
#include <cstdint>

#include "hw_bridge/serve/words.h"
#include "twin/core/errors.h"

namespace twinbench::hw {
namespace {

std::string Word(const std::vector<std::string>& words, std::size_t k) {
  return k < words.size() ? words[k] : std::string();
}

const IiodAttribute* Find(const IiodTarget& target) {
  const auto is_it = [&](const IiodAttribute& a) { return a.name == target.name || a.filename == target.name; };
  const auto found = std::ranges::find_if(*target.attributes, is_it);
  return found == target.attributes->end() ? nullptr : &*found;
}

std::string BigEndian(std::int32_t number) {
  std::string bytes;
  for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(number >> shift & 0xff);
  return bytes;
}

/// { length big-endian, value with a NUL, padding to 4 } for each; a negative length is an error.
std::string ReadAll(const IiodAttributes& attributes) {
  std::string bytes;
  for (const IiodAttribute& attribute : attributes) {
    const std::string value = attribute.read() + '\0';
    bytes += BigEndian(static_cast<std::int32_t>(value.size())) + value;
    bytes.resize((bytes.size() + 3) / 4 * 4);
  }
  return bytes;
}

std::string Counted(const std::string& bytes) {
  return std::to_string(bytes.size()) + "\n" + bytes + "\n";
}

std::string Failure(int error) {
  return std::to_string(-error) + "\n";
}

std::string Clean(const std::string& value) {
  const auto end = value.find_first_of(std::string_view("\0\r\n", 3));
  return value.substr(0, end);
}

}  // namespace

IiodTarget FindIiodTarget(const IiodDevice& device, const std::vector<std::string>& words) {
  const std::string kind = UpperCase(Word(words, 0));
  if (kind == "DEBUG") return {&device.debug, Word(words, 1)};
  if (kind == "BUFFER") return {&device.buffer, Word(words, 1)};
  if (kind != "INPUT" && kind != "OUTPUT") return {&device.attributes, Word(words, 0)};
  const std::string id = Word(words, 1);
  for (const IiodChannel& channel : device.channels) {
    if (kind == "INPUT" && !id.empty() && (channel.id == id || channel.name == id)) {
      return {&channel.attributes, Word(words, 2)};
    }
  }
  return {};
}

std::string ReadIiodAttributes(const IiodTarget& target) {
  if (!target.attributes) return Failure(ENXIO);
  try {
    if (target.name.empty()) return Counted(ReadAll(*target.attributes));
    const IiodAttribute* attribute = Find(target);
    return attribute ? Counted(attribute->read() + '\0') : Failure(ENOENT);
  } catch (const BenchError&) {
    return Failure(EIO);
  }
}

int WriteIiodAttribute(const IiodTarget& target, std::string value) {
  if (!target.attributes) return -ENXIO;
  const IiodAttribute* attribute = target.name.empty() ? nullptr : Find(target);
  if (!attribute) return -ENOENT;
  if (!attribute->write) return -EACCES;
  try {
    return attribute->write(Clean(value)) ? static_cast<int>(value.size()) : -EINVAL;
  } catch (const BenchError&) {
    return -EIO;
  }
}

}  // namespace twinbench::hw
