// The panel beside the picture: shows what the worker tells, and tells it what is changed.

const $ = (id) => document.querySelector(`#${id}`);

// Five digits.
const number = (value) => String(Number(value.toPrecision(5)));
const triple = (values) => values.map(number).join(", ");

// What is written in a field of numbers, or nothing.
const numberIn = (id) => ($(id).value === "" ? null : Number($(id).value));

// Leaves alone what someone is writing in.
function write(id, value) {
  const field = $(id);
  if (document.activeElement !== field && field.value !== String(value)) {
    field.value = value;
  }
}

function element(name, text, children = []) {
  const made = document.createElement(name);
  made.textContent = text;
  made.append(...children);
  return made;
}

const row = ([name, value]) => element("tr", "", [element("th", name), element("td", value)]);

function choose(id, names, chosen) {
  const list = $(id);
  const found = Array.from(list.options, (option) => option.value);
  if (found.join("\n") !== names.join("\n")) {
    list.replaceChildren(...names.map((name) => new Option(name)));
  }
  write(id, chosen);
}

function tellScene(scene) {
  document.title = `${scene.name} – metaball`;
  $("name").textContent = scene.name;
  $("facts").replaceChildren(
    ...[
      ["Balls", String(scene.balls)],
      ["Size", scene.size.map(number).join(" × ")],
      ["Tree", `${scene.build_ms.toFixed(0)} ms, ${(scene.tree_bytes / 1e6).toFixed(1)} MB`],
    ].map(row),
  );
  const note = ([kind, text]) => element("li", "", [element("b", kind), ` ${text}`]);
  $("notes").replaceChildren(...scene.notes.map(note));
  $("legend").hidden = !scene.legend;
  if (scene.legend) {
    $("legend").src = `data:image/svg+xml,${encodeURIComponent(scene.legend)}`;
    $("legend").alt = `Legend of ${scene.color_by}`;
  }
  choose("kernel", scene.kernels, scene.kernel);
  write("threshold", scene.threshold);
  $("own-field").disabled = scene.is_own_field;
  write("radius-scale", scene.radius_scale);
  write("color-by", scene.color_by ?? "");
  write("frame", scene.frame ?? "");
  write("shown", scene.shown);
}

function tellCut({ normals, cut }) {
  const index = cut ? normals.findIndex(([normal]) => String(normal) === String(cut[0])) : -1;
  const chosen = cut ? (normals[index]?.[1] ?? "toward the eye") : "nothing";
  choose("normal", ["nothing", ...normals.map(([, name]) => name)], chosen);
  $("offset").disabled = !cut;
  if (cut && index >= 0) {
    const [, , from, to] = normals[index];
    Object.assign($("offset"), { min: from, max: to });
  }
  if (cut) {
    write("offset", cut[1]);
  }
}

function tellLight(light) {
  for (const name of ["shadows", "occlusion"]) {
    $(name).checked = light[name];
  }
  const isFluid = light.material === "clear fluid";
  $("shadows").disabled = isFluid;
  $("occlusion").disabled = isFluid;
  $("lamp-size").disabled = !light.shadows;
  write("lamp-size", light.lamp_size);
  write("material", light.material);
  write("floor", light.floor);
  write("exposure", light.exposure);
  write("samples", light.samples);
}

function tellPoints({ points, distance }) {
  $("no-points").hidden = points.length > 0;
  $("forget").hidden = points.length === 0;
  const told = points.flatMap((point, index) => {
    const where = point.is_inside ? "the eye, within the solid" : "on the face of the cut";
    const facts = [
      ["Position", triple(point.position)],
      ["Normal", triple(point.normal)],
      ["t", number(point.t)],
      ["Field", number(point.field)],
    ];
    if (point.is_inside || point.on_face) {
      facts.push(["Where", where]);
    }
    const heading = points.length > 1 ? [element("b", `Point ${index + 1}`)] : [];
    return [...heading, element("table", "", facts.map(row))];
  });
  if (distance !== null) {
    told.push(element("b", `Distance ${number(distance)}`));
  }
  const last = points.at(-1);
  if (last) {
    const makers = last.balls === 1 ? "One ball makes it:" : `${last.balls} balls make it:`;
    told.push(element("p", makers), element("table", "", shares(last)));
    const others = last.balls - last.shares.length;
    if (others > 0) {
      told.push(element("p", `and ${others} others`));
    }
  }
  $("points").replaceChildren(...told);
}

function shares({ shares }) {
  return shares.map(([ball, value, share]) => {
    const meter = document.createElement("meter");
    meter.value = share;
    const cells = [`#${ball}`, number(value), `${(100 * share).toFixed(1)} %`];
    const made = element("tr", "", cells.map((text) => element("td", text)));
    made.append(element("td", "", [meter]));
    return made;
  });
}

function tellPicture({ picture, scene, light }, canvas) {
  canvas.dataset.stage = picture?.is_latest ? picture.stage : "";
  canvas.ariaLabel = `Picture of ${scene?.name ?? "nothing yet"}`;
  if (!picture) {
    $("status").textContent = "";
    return;
  }
  const size = `${picture.width} × ${picture.height}`;
  const time = picture.ms < 2000 ? `${picture.ms.toFixed(0)} ms` : `${(picture.ms / 1e3).toFixed(1)} s`;
  const words = {
    coarse: `Moving, ${size}, ${(picture.rate ?? 0).toFixed(0)} frames a second`,
    sharp: `${size}, ${time}`,
    lit: `${size}, light ${picture.samples} of ${light.samples}, ${time}`,
  };
  const certain =
    picture.undecided > 0 ? `${picture.undecided} pixels undecided` : "every pixel certain";
  $("status").textContent = `${words[picture.stage]}, ${certain}`;
}

function tellNotice({ progress, failure }) {
  const doing = { reading: "Reading the file …", building: "Building the tree …" };
  $("notice").textContent = failure ?? doing[progress] ?? "";
  $("notice").classList.toggle("failure", failure !== null);
}

// Listens to all widgets. What it returns shows a state.
export function panel({ act, open, canvas }) {
  let state = null;
  const on = (ids, event, obey) => ids.forEach((id) => $(id).addEventListener(event, obey));

  on(["file"], "change", () => $("file").files[0] && open($("file").files[0]));
  on(["kernel"], "change", () => act("kernel", { name: $("kernel").value }));
  on(["threshold"], "change", () => {
    const value = numberIn("threshold");
    act(...(value === null ? ["own_field"] : ["threshold", { value }]));
  });
  on(["own-field"], "click", () => act("own_field"));
  on(["radius-scale", "color-by", "frame"], "change", () =>
    act("read", {
      radius_scale: numberIn("radius-scale"),
      color_by: $("color-by").value.trim() || null,
      frame: numberIn("frame"),
    }),
  );
  on(["shown"], "change", () => act("show", { picture: $("shown").value }));
  on(
    ["shadows", "lamp-size", "occlusion", "material", "floor", "exposure", "samples"],
    "change",
    () =>
      act("light", {
        shadows: $("shadows").checked,
        lamp_size: numberIn("lamp-size") ?? 0,
        occlusion: $("occlusion").checked,
        material: $("material").value,
        floor: $("floor").value,
        exposure: numberIn("exposure") ?? 0,
        samples: numberIn("samples") ?? 1,
      }),
  );
  on(["normal"], "change", () => {
    const found = state.scene.normals.find(([, name]) => name === $("normal").value);
    const middle = found && 0.5 * (found[2] + found[3]);
    act("cut", { plane: found ? [found[0], middle] : null });
  });
  on(["offset"], "input", () =>
    act("cut", { plane: [state.scene.cut[0], Number($("offset").value)] }),
  );
  on(["forget"], "click", () => act("forget"));
  on(["copy"], "click", () => navigator.clipboard.writeText($("command").value));
  on(["save"], "click", () => canvas.toBlob((blob) => save(blob, state?.scene?.name)));

  return (told) => {
    state = told;
    tellNotice(told);
    tellPicture(told, canvas);
    if (told.scene) {
      tellScene(told.scene);
      tellCut(told.scene);
    }
    tellLight(told.light);
    tellPoints(told);
    write("command", told.command ?? "");
  };
}

function save(blob, name) {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(blob);
  link.download = `${(name ?? "picture").split(".")[0]}.png`;
  link.click();
  URL.revokeObjectURL(link.href);
}
