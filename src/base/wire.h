// Values to bytes and back. Both ends run the same program on the same kind of machine.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "base/bytes.h"
#include "base/camera.h"
#include "base/vector.h"

namespace pprt {

// The last value of an enumeration that travels. Each specialises it beside its message.
template <typename E>
inline constexpr E kLast = E::has_no_last_value;

class WireWriter {
 public:
  template <typename T>
  requires std::is_trivially_copyable_v<T>
  void put(const T& value) { append(&value, sizeof value); }
  void put(const Vec3d& v) { put(v.x), put(v.y), put(v.z); }
  void put(const Color& c) { put(c.x), put(c.y), put(c.z); }
  void put(const Camera& c) {
    put(c.eye), put(c.right), put(c.up), put(c.forward);
    put(c.slope_per_pixel), put(c.width), put(c.height);
  }
  void put(const std::string& text) {
    put_count(text.size());
    append(text.data(), text.size());
  }
  template <typename T>
  requires std::is_trivially_copyable_v<T>
  void put_all(std::span<const T> values) {
    put_count(values.size());
    append(values.data(), values.size_bytes());
  }
  void put_all(std::span<const Color> colors) {
    static_assert(sizeof(Color) == 3 * sizeof(float));
    put_count(colors.size());
    append(colors.data(), colors.size_bytes());
  }

  // Makes room for so many bytes.
  void reserve(std::size_t bytes) { bytes_.reserve(bytes); }

  Bytes take() { return std::move(bytes_); }

 private:
  // Throws ProtocolError for more than 2^32 - 1.
  void put_count(std::size_t count) {
    if (count > std::numeric_limits<std::uint32_t>::max()) throw ProtocolError("a message is too long");
    put(static_cast<std::uint32_t>(count));
  }
  void append(const void* data, std::size_t size) {
    const auto* first = static_cast<const std::byte*>(data);
    bytes_.insert(bytes_.end(), first, first + size);
  }

  Bytes bytes_;
};

// Throws ProtocolError when the bytes end too soon, or hold a value that its type has not.
class WireReader {
 public:
  explicit WireReader(std::span<const std::byte> bytes) : rest_(bytes) {}

  template <typename T>
  requires(std::is_trivially_copyable_v<T> && !std::is_enum_v<T>) void get(T& value) {
    copy_out(&value, sizeof value);
  }
  void get(bool& value) {
    std::uint8_t byte = 0;
    get(byte);
    if (byte > 1) throw ProtocolError("a message holds neither yes nor no");
    value = byte != 0;
  }
  // One of an enumeration; see kLast.
  template <typename E>
  requires std::is_enum_v<E>
  void get(E& value) {
    std::underlying_type_t<E> number = 0;
    get(number);
    if (number > static_cast<std::underlying_type_t<E>>(kLast<E>))
      throw ProtocolError("a message holds a choice that there is not");
    value = static_cast<E>(number);
  }
  void get(Vec3d& v) { get(v.x), get(v.y), get(v.z); }
  void get(Color& c) { get(c.x), get(c.y), get(c.z); }
  void get(Camera& c) {
    get(c.eye), get(c.right), get(c.up), get(c.forward);
    get(c.slope_per_pixel), get(c.width), get(c.height);
  }
  void get(std::string& text) {
    text.resize(count(1));
    copy_out(text.data(), text.size());
  }
  template <typename T>
  requires std::is_trivially_copyable_v<T>
  void get_all(std::vector<T>& values) {
    values.resize(count(sizeof(T)));
    copy_out(values.data(), values.size() * sizeof(T));
  }
  void get_all(std::vector<Color>& colors) {
    colors.resize(
        count(sizeof(Color)));  // leaves them as they are: most of a message must not be written twice
    for (Color& c : colors) copy_out(&c.x, sizeof(Color));
  }

  // Returns what is left.
  std::span<const std::byte> rest() const { return rest_; }

  // Call it after the last value.
  void expect_end() const {
    if (!rest_.empty()) throw ProtocolError("a message holds more than it should");
  }

 private:
  // A length that what is left can hold: a broken one must not take the memory.
  std::size_t count(std::size_t element_size) {
    std::uint32_t n = 0;
    get(n);
    if (n > rest_.size() / element_size) throw ProtocolError("a message announces more than it holds");
    return n;
  }
  void copy_out(void* to, std::size_t size) {
    if (size > rest_.size()) throw ProtocolError("a message ends too soon");
    if (size > 0) std::memcpy(to, rest_.data(), size);
    rest_ = rest_.subspan(size);
  }

  std::span<const std::byte> rest_;
};

// --- Values whose fields are listed once, for both directions: fields_of(code, value) calls code(field, ...)

class FieldWriter {
 public:
  explicit FieldWriter(WireWriter& out) : out_(out) {}
  template <typename... Field>
  void operator()(const Field&... fields) {
    (put(fields), ...);
  }
  WireWriter& wire() { return out_; }

 private:
  template <typename T>
  void put(const T& value) {
    out_.put(value);
  }
  template <typename T>
  void put(const std::vector<T>& values) {
    out_.put_all(std::span<const T>(values));
  }

  WireWriter& out_;
};

class FieldReader {
 public:
  explicit FieldReader(WireReader& in) : in_(in) {}
  template <typename... Field>
  void operator()(Field&... fields) {
    (get(fields), ...);
  }
  WireReader& wire() { return in_; }

 private:
  template <typename T>
  void get(T& value) {
    in_.get(value);
  }
  template <typename T>
  void get(std::vector<T>& values) {
    in_.get_all(values);
  }

  WireReader& in_;
};

// Whether a value is a T, constant or not.
template <typename Value, typename T>
concept Either = std::is_same_v<std::remove_const_t<Value>, T>;

}  // namespace pprt
