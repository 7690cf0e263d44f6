// The simulation, on a thread of its own, so that the page never waits for it.

let wasm;
const loaded = WebAssembly.instantiateStreaming(fetch("rolls.wasm")).then(({ instance }) => {
  wasm = instance.exports;
});

// Copies a buffer that the library has lent.
const copy = (Type, address) => new Type(wasm.memory.buffer, address, wasm.length()).slice();

function check(code) {
  if (code !== 0) throw new Error(new TextDecoder().decode(copy(Uint8Array, wasm.error())));
}

const numbers = ({ friction, inelasticity, gravity, amplitude, frequency }) =>
  [friction, inelasticity, gravity, amplitude, frequency];

// Goes on by so many oscillations, or until the time is up. How a run is cut does not change it.
function run(oscillations, milliseconds, marks) {
  const [start, first] = [performance.now(), wasm.oscillation()];
  let left = oscillations;
  while (left > 0 && performance.now() - start < milliseconds) {
    const part = Math.min(left, 1);
    check(wasm.advance(part, marks ? 1 : 0));
    left = oscillations - (wasm.oscillation() - first);
  }
  return performance.now() - start;
}

function frame(busy) {
  const disks = copy(Float32Array, wasm.disks());
  const flow = copy(Float32Array, wasm.flow());
  const history = copy(Float64Array, wasm.history());
  const marks = copy(Float32Array, wasm.marks());
  const answer = {
    disks, flow, history, marks, busy,
    oscillation: wasm.oscillation(),
    collisions: wasm.collisions(),
    base: wasm.base_displacement(),
    waiting: wasm.is_waiting() === 1,
    hash: BigInt.asUintN(64, wasm.hash()).toString(16).padStart(16, "0"),
  };
  postMessage(answer, [disks.buffer, flow.buffer, history.buffer, marks.buffer]);
}

const deeds = {
  create: ({ seed, settings }) => check(wasm.create(seed, ...numbers(settings))),
  set: ({ settings }) => check(wasm.set(...numbers(settings))),
  frame: ({ oscillations, milliseconds, marks }) => frame(run(oscillations, milliseconds, marks)),
  step: () => { check(wasm.step()); frame(0); },
  lines: ({ changes }) => postMessage({ lines: changes.map((change) => copy(Float64Array, wasm.iso_line(change))) }),
};

onmessage = async ({ data }) => {
  try {
    await loaded;
    deeds[data.deed](data);
  } catch (error) {
    postMessage({ failure: error.message });
  }
};
