# rooms.awk SYMBOLS PROFILE...: what each room of the source tree costs, from profiles of Callgrind.
#
# SYMBOLS is the output of nm -A for the object files of src/, with mangled names. PROFILE is a file of callgrind with
# --cache-sim=yes --demangle=no. Prints for each room: name, instructions, D1 misses, LL read misses, LL write misses,
# summed over the profiles.
#
# A function counts for the room of its source file. Functions without one count for the rooms of their callers, in
# proportion to what the calls cost: those of libraries, of rooms that serve all, and templates that several rooms share.

# The room of an object file, or "".
function room_of(path) {
  # Sources that are compiled as one (pprt_compile_as): unity_ROOM_cxx or unity_ROOM-PART_cxx.
  if (match(path, /\/Unity\/unity_(sampling|reconstruction|preparation|left-out|exchange)/))
    return substr(path, RSTART + 13, RLENGTH - 13)
  if (path ~ /\/lattice\/node_prediction\.cpp/) return ""
  if (path ~ /\/mesh\/(delaunay|fan_weights|sample_mesh|seeds|predicates)\.cpp/) return "sampling"
  if (path ~ /\/lattice\/lattice_(refiner|store)\.cpp|\/lattice\/.*errors?/) return "sampling"
  if (path ~ /\/mesh\/reconstruction\.cpp|\/lattice\/lattice_painter\.cpp/) return "reconstruction"
  if (path ~ /pipeline.*\/casting\/|\/(mesh_casting|reprojection|anchor_search|worker_prepare)\.cpp/) return "preparation"
  if (path ~ /src\/parallel\/.*\/(master|mosaic|frame_assembly)\.cpp/) return "left-out"
  if (path ~ /src\/parallel\//) return "exchange"
  if (path ~ /src\/trace\//) return "tracing"
  return ""
}

# The text behind "(7) text"; "(7)" stands for the text that came with it before.
function name_of(kind, field, id, text) {
  id = field
  sub(/\).*/, "", id)
  text = field
  if (sub(/^[^)]*\) /, "", text)) names[kind, id] = text
  return names[kind, id]
}

# A function, whatever the depth of its recursion.
function node_of(object, name) {
  sub(/'[0-9]+$/, "", name)
  nodes[object "\t" name] = 1
  return object "\t" name
}

function add(sums, key) {
  sums[key, 1] += $2
  sums[key, 2] += $6 + $7
  sums[key, 3] += $9
  sums[key, 4] += $10
}

FILENAME == ARGV[1] {
  sub(/:[0-9a-f]+$/, "", $1)
  here = room_of($1)
  if (!($3 in rooms)) rooms[$3] = here
  else if (rooms[$3] != here) rooms[$3] = ""
  next
}

FNR == 1 { delete names }
/^ob=/ { object = callee_object = name_of("object", substr($0, 4)); next }
/^fn=/ { node = node_of(object, name_of("function", substr($0, 4))); next }
/^cob=/ { callee_object = name_of("object", substr($0, 5)); next }
/^cfn=/ { callee = node_of(callee_object, name_of("function", substr($0, 5))); callee_object = object; next }
/^calls=/ { is_call = 1; next }
/^[0-9+*-]/ {
  if (!is_call) {
    add(self, node)
  } else if (callee != node) {
    edges[node SUBSEP callee] = 1
    add(of_edge, node SUBSEP callee)
    add(of_callee, callee)
  }
  is_call = 0
}

# "left-out" is not printed: what ranks do while they wait, as often as the machine lets them, Open MPI's own library, and
# the master's work, which falls into Worker::render or beside it as messages come.
function settle(node, parts) {
  split(node, parts, "\t")
  if (parts[1] ~ /libmpi|libopen-|\/openmpi\/|libpmix/ ||
      parts[2] ~ /BundleExchange(5await|4rest|4poll|11await_seeds)|12rest_briefly|Communicator7receive/ ||
      parts[2] ~ /5Inbox(4pump|13count_bundles)|11is_of_round|8is_readyE|9has_seedsE|13decode_pixels/)
    return "left-out"
  if (parts[1] ~ /libembree/) return "Embree"
  return parts[1] ~ /\/pprt-render$/ ? rooms[parts[2]] : ""
}

# One step of handing the costs of functions without a room to their callers.
function hand_up(edge, ends, e, r, weight) {
  delete next_share
  for (edge in edges) {
    split(edge, ends, SUBSEP)
    if (settled[ends[2]] != "") continue
    for (e = 1; e <= 4; ++e) {
      if (!of_callee[ends[2], e]) continue
      weight = of_edge[edge, e] / of_callee[ends[2], e]
      if (settled[ends[1]] != "") {
        next_share[ends[2], e, settled[ends[1]]] += weight
      } else {
        for (r = 1; r <= count; ++r) next_share[ends[2], e, all[r]] += weight * share[ends[1], e, all[r]]
      }
    }
  }
  delete share
  for (e in next_share) share[e] = next_share[e]
}

END {
  count = split("tracing Embree sampling reconstruction preparation exchange left-out", all, " ")
  for (node in nodes) settled[node] = settle(node)
  for (step = 1; step <= 20; ++step) hand_up()
  for (node in nodes) {
    for (e = 1; e <= 4; ++e) {
      if (settled[node] != "") cost[settled[node], e] += self[node, e]
      else for (r = 1; r <= count; ++r) cost[all[r], e] += self[node, e] * share[node, e, all[r]]
    }
  }
  for (r = 1; r < count; ++r)
    printf "%s %.0f %.0f %.0f %.0f\n", all[r], cost[all[r], 1], cost[all[r], 2], cost[all[r], 3], cost[all[r], 4]
}
