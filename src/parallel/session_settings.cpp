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
  WireReader(bytes).get(settings);
  return settings;
}

}  // namespace pprt
