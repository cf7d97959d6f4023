// An arithmetic coder after G. N. N. Martin ("Range encoding", 1979) with carry propagation as in LZMA. It
// writes symbols in as many bits as their probabilities say, in integer arithmetic alone: the bytes are the
// same on every machine.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace astrolith {

// Probabilities are shares of this many.
inline constexpr std::uint32_t kProbabilityScale = 65536;

inline constexpr std::size_t kMostZerosLeftOut = 64;

class RangeEncoder {
 public:
  // Writes a symbol that has the shares [start, start + size) of `total`. 0 < size, total <= 65536.
  void encode(std::uint32_t start, std::uint32_t size, std::uint32_t total);
  // Writes a value below `count` > 0, all of which are equally probable.
  void encode_uniform(std::uint64_t value, std::uint64_t count);
  // Writes any number. Small ones take fewer bits: 6 and their own.
  void encode_number(std::uint64_t value);

  // Ends the stream and returns its bytes without the zeros at its end, of which it leaves out at most
  // kMostZerosLeftOut.
  std::string finish();

 private:
  void shift_low();

  std::string bytes_;
  std::uint64_t low_ = 0;
  std::uint32_t range_ = 0xffffffffu;
  std::uint8_t pending_ = 0;         // the last byte, which a carry can still change
  std::uint64_t pending_count_ = 0;  // of it and the bytes 255 that follow it
};

// Reads what RangeEncoder wrote. Any bytes decode to something. kMostZerosLeftOut zeros follow their end;
// further on every function throws DamagedStream, so that a few bytes cannot go on for ever.
class RangeDecoder {
 public:
  // `bytes` must outlive this.
  explicit RangeDecoder(std::string_view bytes);

  // The share at which the next symbol stands, below `total`. take() must follow with the symbol's shares.
  std::uint32_t share(std::uint32_t total);
  void take(std::uint32_t start, std::uint32_t size);

  // Throws DamagedStream if the value is not below `count`.
  std::uint64_t decode_uniform(std::uint64_t count);
  std::uint64_t decode_number();

 private:
  std::uint8_t next_byte();

  std::string_view bytes_;
  std::size_t position_ = 0;
  std::uint32_t code_ = 0;
  std::uint32_t range_ = 0xffffffffu;
};

// The stream cannot come from an encoder. Readers turn this into an InputError that names the file.
struct DamagedStream {};

}  // namespace astrolith
