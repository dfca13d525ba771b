"use strict";
// The deformed rods in 3D, a scene for each model, that turn together.
(() => {
  const place = document.getElementById("turning"), controls = document.getElementById("turning-controls");
  if (!document.createElement("canvas").getContext("webgl")) {
    place.textContent = "This browser has no WebGL to draw with; the picture below stands still.";
    return;
  }
  const LARGEST = 32767;

  function numbers(text, Kind) {
    return new Kind(Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0)).buffer);
  }

  // Columns x, y, z of positions, in half extents, and values in their unit.
  function points(part) {
    const whole = numbers(part.position, Int16Array), columns = [[], [], []];
    whole.forEach((value, index) => columns[index % 3].push(value / LARGEST));
    const value = Array.from(numbers(part.value, Int16Array), (each) => (each / LARGEST) * part.scale);
    return {x: columns[0], y: columns[1], z: columns[2], value};
  }

  // Triangles of a rod's skin: between sections along every border, and a cap at each end.
  function triangles(skin) {
    const around = skin.loops.reduce((sum, count) => sum + count, 0), i = [], j = [], k = [];
    for (let section = 0; section + 1 < skin.sections; section += 1) {
      let start = section * around;
      for (const count of skin.loops) {
        for (let at = 0; at < count; at += 1) {
          const one = start + at, other = start + ((at + 1) % count);
          i.push(one, one); j.push(other, other + around); k.push(other + around, one + around);
        }
        start += count;
      }
    }
    const cap = numbers(skin.cap, Uint32Array);
    for (const first of [0, (skin.sections - 1) * around]) {
      for (let at = 0; at < cap.length; at += 3) {
        i.push(first + cap[at]); j.push(first + cap[at + 1]); k.push(first + cap[at + 2]);
      }
    }
    return {i, j, k};
  }

  // Lines along the corners of a section, and around both ends.
  function outline(skin, found) {
    const around = skin.loops.reduce((sum, count) => sum + count, 0), paths = [];
    for (const corner of skin.corners) {
      paths.push(Array.from({length: skin.sections}, (_, section) => section * around + corner));
    }
    for (const first of [0, (skin.sections - 1) * around]) {
      let start = first;
      for (const count of skin.loops) {
        const from = start;
        paths.push(Array.from({length: count + 1}, (_, at) => from + (at % count)));
        start += count;
      }
    }
    const column = (axis) => paths.flatMap((path) => [...path.map((at) => found[axis][at]), null]);
    return {x: column("x"), y: column("y"), z: column("z")};
  }

  const traces = [], shown = [];  // what each trace belongs to: "stress", "pressure" or "both"
  function add(kind, trace) {
    traces.push({hoverinfo: "skip", showscale: false, visible: kind !== "pressure", ...trace});
    shown.push(kind);
  }
  const light = {ambient: 1, diffuse: 0, specular: 0};  // colours are numbers, which shade would change
  turning.models.forEach((model, number) => {
    const scene = number ? `scene${number + 1}` : "scene";
    model.rods.forEach((part, at) => {
      const skin = turning.skins[at], found = points(part), mesh = triangles(skin);
      const where = {type: "mesh3d", scene, x: found.x, y: found.y, z: found.z, ...mesh, flatshading: true};
      add("stress", {
        ...where, intensity: found.value, coloraxis: "coloraxis", lighting: light, hoverinfo: "all",
        customdata: found.value, hovertemplate: `${skin.name}: %{customdata:.4g} MPa<extra></extra>`,
      });
      add("pressure", {...where, color: "#8a94a0", opacity: 0.16, lighting: light});
      add("both", {
        type: "scatter3d", mode: "lines", scene, ...outline(skin, found), line: {color: "#1f2933", width: 1.5},
        showlegend: false,
      });
    });
    for (const part of model.faces) {
      const found = points(part), corners = numbers(part.triangles, Uint32Array);
      const column = (first) => Array.from(corners).filter((_, at) => at % 3 === first);
      add("pressure", {
        type: "mesh3d", scene, x: found.x, y: found.y, z: found.z, i: column(0), j: column(1), k: column(2),
        intensity: found.value, coloraxis: "coloraxis2", lighting: light,
        hoverinfo: "all", customdata: found.value, hovertemplate: "%{customdata:.4g} MPa<extra></extra>",
      });
    }
  });

  const scenes = turning.models.map((_, number) => (number ? `scene${number + 1}` : "scene"));
  const width = () => place.parentNode.clientWidth;
  const narrow = () => width() < 700 && scenes.length > 1;
  const vector = ([x, y, z], size = 1) => ({x: x * size, y: y * size, z: z * size});
  const HEIGHT = 400, NARROW_HEIGHT = 270, BELOW = 66;  // of a scene, and of the colours' scale, pixels

  // The whole is seen from a distance at which a field of view of 45 degrees holds it.
  function beginning() {
    const [wide, high, deep] = turning.size, field = 2 * Math.tan(Math.PI / 8);
    const shape = narrow() ? width() / NARROW_HEIGHT : width() / scenes.length / HEIGHT;
    const distance = Math.max((1.12 * wide) / (field * shape), (1.3 * high) / field, 0.3) + 0.5 * deep;
    return {eye: vector(turning.towards, distance), up: vector(turning.up), center: vector([0, 0, 0])};
  }

  // ColorBrewer's RdBu, which colour-blind readers can tell apart
  const TENSION_RED = ["#2166ac", "#67a9cf", "#d1e5f0", "#f0f0ee", "#fddbc7", "#ef8a62", "#b2182b"].map(
    (colour, at) => [at / 6, colour]);
  const hidden = {visible: false, showspikes: false};
  let camera = beginning();
  function layout() {
    const stacked = narrow(), count = scenes.length, bar = {
      orientation: "h", x: 0.5, y: 0, yanchor: "top", len: 0.7, thickness: 12, outlinewidth: 0,
    };
    const found = {
      height: (stacked ? NARROW_HEIGHT * count : HEIGHT) + BELOW, margin: {l: 0, r: 0, t: 8, b: BELOW},
      paper_bgcolor: "#ffffff", showlegend: false,
      font: {family: "system-ui, sans-serif", size: 13, color: "#1f2933"}, annotations: [],
      coloraxis: {
        colorscale: TENSION_RED, cmin: -turning.stress, cmax: turning.stress,
        colorbar: {...bar, title: {text: "σ<sub>s</sub>, MPa", side: "bottom"}},
      },
      coloraxis2: {
        colorscale: "Viridis", reversescale: true, cmin: 0, cmax: turning.pressure,
        colorbar: {...bar, title: {text: "p<sub>n</sub>, MPa", side: "bottom"}},
      },
    };
    scenes.forEach((scene, number) => {
      const from = number / count, to = (number + 1) / count;
      const domain = stacked ? {x: [0, 1], y: [1 - to, 1 - from]} : {x: [from, to], y: [0, 1]};
      const range = turning.reach.map((reach) => [-1.02 * reach - 0.02, 1.02 * reach + 0.02]);
      const sizes = range.map(([low, high]) => (high - low) / 2);
      found[scene] = {
        domain, camera, dragmode: "orbit", aspectmode: "manual",
        aspectratio: {x: sizes[0], y: sizes[1], z: sizes[2]},
        xaxis: {...hidden, range: range[0]}, yaxis: {...hidden, range: range[1]}, zaxis: {...hidden, range: range[2]},
      };
      found.annotations.push({
        text: turning.models[number].name, showarrow: false, x: domain.x[0] + 0.01, y: domain.y[1], xref: "paper",
        yref: "paper", xanchor: "left", yanchor: "top", font: {size: 14},
      });
    });
    return found;
  }

  let asked = false;
  function turnAll(next, besides) {
    camera = next;
    const change = {};
    for (const scene of scenes) if (scene !== besides) change[`${scene}.camera`] = camera;
    return Plotly.relayout(place, change);
  }
  function follow(change) {
    const scene = scenes.find((each) => change[`${each}.camera`]);
    if (!scene || asked) return;
    asked = true;
    requestAnimationFrame(() => turnAll(change[`${scene}.camera`], scene).then(() => { asked = false; }));
  }

  const cross = (a, b) => ({x: a.y * b.z - a.z * b.y, y: a.z * b.x - a.x * b.z, z: a.x * b.y - a.y * b.x});
  const dot = (a, b) => a.x * b.x + a.y * b.y + a.z * b.z;
  // Rodrigues' formula
  function turned(vector, axis, angle) {
    const size = Math.sqrt(dot(axis, axis)), k = {x: axis.x / size, y: axis.y / size, z: axis.z / size};
    const c = Math.cos(angle), s = Math.sin(angle), aside = cross(k, vector), along = dot(k, vector) * (1 - c);
    return {
      x: vector.x * c + aside.x * s + k.x * along, y: vector.y * c + aside.y * s + k.y * along,
      z: vector.z * c + aside.z * s + k.z * along,
    };
  }
  const STEP = Math.PI / 12;
  function step(way) {
    const {eye, up} = camera, sideways = cross(up, eye);
    switch (way) {
      case "left": return {...camera, eye: turned(eye, up, -STEP)};
      case "right": return {...camera, eye: turned(eye, up, STEP)};
      case "up": return {...camera, eye: turned(eye, sideways, -STEP), up: turned(up, sideways, -STEP)};
      case "down": return {...camera, eye: turned(eye, sideways, STEP), up: turned(up, sideways, STEP)};
      case "in": return {...camera, eye: {x: eye.x / 1.25, y: eye.y / 1.25, z: eye.z / 1.25}};
      case "out": return {...camera, eye: {x: eye.x * 1.25, y: eye.y * 1.25, z: eye.z * 1.25}};
      default: return beginning();
    }
  }

  Plotly.newPlot(place, traces, layout(), {displayModeBar: false, responsive: true}).then(() => {
    place.on("plotly_relayouting", follow);
    place.on("plotly_relayout", follow);
    controls.hidden = false;
    place.dataset.drawn = String(scenes.length);
  });
  for (const button of controls.querySelectorAll("[data-turn]")) {
    button.addEventListener("click", () => turnAll(step(button.dataset.turn)));
  }
  for (const choice of controls.querySelectorAll("[name=shown]")) {
    choice.addEventListener("change", () => {
      Plotly.restyle(place, {visible: shown.map((kind) => kind === "both" || kind === choice.value)});
    });
  }
  let stacked = narrow();
  addEventListener("resize", () => {
    if (narrow() !== stacked) {
      stacked = narrow();
      camera = beginning();
      Plotly.relayout(place, layout());
    }
  });
})();
