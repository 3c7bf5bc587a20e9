#include "parallel/session_settings.h"

#include "parallel/wire.h"

namespace pprt {

Bytes encode(const SessionSettings& settings) {
  WireWriter out;
  out.put(settings);
  return out.take();
}

SessionSettings decode_settings(const Bytes& bytes) {
  SessionSettings settings;
  WireReader in(bytes);
  in.get(settings);
  in.expect_end();
  return settings;
}

}  // namespace pprt
