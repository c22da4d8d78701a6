"use strict";
// The rows and plots of a report. Every name comes in as data and goes out as text; nothing is fetched.
(async () => {
  const root = document.documentElement;
  const $ = (id) => document.getElementById(id);
  const make = (tag, text, set = {}) => Object.assign(document.createElement(tag), text === null ? {} : { textContent: text }, set);

  async function inflated(id) {
    const packed = atob($(id).textContent.trim());
    const bytes = Uint8Array.from(packed, (c) => c.charCodeAt(0));
    const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"));
    return new Response(stream).text();
  }

  if (typeof DecompressionStream === "undefined") {
    $("count").textContent = "This browser cannot unpack the rows; the figures stand as they are, and rows.csv has all numbers.";
    return;
  }
  const data = JSON.parse(await inflated("data"));
  const { columns, rows, replay } = data.table;
  const place = new Map(columns.map((column, i) => [column.name, i]));
  const cell = (column, row) => {
    const value = column.values[row];
    return column.words && value !== null ? column.words[value] : value;
  };
  const number = (x) => (x === "∞" ? Infinity : x === "−∞" ? -Infinity : x);
  const shown = (value) => (value === null ? "" : String(value));
  const titled = (column) => column.name + (column.unit ? ` [${column.unit}]` : "");

  // ---- rows: filter, sort, choose
  const state = { order: [], picks: [], sort: null, falls: false, most: 100, all: false, chosen: null, unknown: [] };
  const visible = () => columns.filter((column) => state.all || column.telling);

  function parsed(text) {
    const tests = [];
    const unknown = [];
    for (const token of text.match(/(?:[^\s"]+|"[^"]*")+/g) ?? []) {
      const word = token.replace(/"/g, "");
      const match = word.match(/^([^=<>!]+)(!=|<=|>=|=|<|>)(.*)$/);
      const column = match && (columns[place.get(match[1])] ?? only(match[1]));
      if (match && !column) unknown.push(match[1]);
      if (!column) {
        const sought = word.toLowerCase();
        tests.push((row) => visible().some((column) => shown(cell(column, row)).toLowerCase().includes(sought)));
        continue;
      }
      const [sign, wanted] = [match[2], match[3]];
      const same = (value) => shown(value) === wanted || (wanted !== "" && value !== null && Number(number(value)) === Number(wanted)) ||
        (column.name === "case" && wanted !== "" && shown(value).startsWith(wanted));
      tests.push((row) => {
        const value = cell(column, row);
        if (sign === "=") return same(value);
        if (sign === "!=") return !same(value);
        if (value === null) return false;
        const [a, b] = [Number(number(value)), Number(wanted)];
        return sign === "<" ? a < b : sign === ">" ? a > b : sign === "<=" ? a <= b : a >= b;
      });
    }
    state.unknown = unknown;
    return tests;
  }

  function only(ending) {
    const found = columns.filter((column) => column.name.endsWith(`.${ending}`) || column.name.startsWith(ending));
    return found.length === 1 ? found[0] : null;
  }

  function arrange() {
    const tests = parsed($("filter").value);
    for (const [name, pick] of state.picks) {
      const column = columns[place.get(name)];
      if (!column) continue;
      // A number is written in several ways: 1e-3 is 0.001.
      const key = (value) => (column.words ? shown(value) : String(Number(number(value))));
      const keys = new Set((pick["one-of"] ?? pick["none-of"] ?? []).map(key));
      const [low, high] = pick.between ?? [];
      tests.push((row) => {
        const value = cell(column, row);
        if (value === null) return false;
        if (pick.between) return number(value) >= low && number(value) <= high;
        return keys.has(key(value)) === Boolean(pick["one-of"]);
      });
    }
    state.order = [];
    for (let row = 0; row < rows.length; row += 1) {
      if (tests.every((test) => test(row))) state.order.push(row);
    }
    const column = columns[place.get(state.sort)];
    if (column) {
      const by = (a, b) => {
        const [x, y] = [cell(column, a), cell(column, b)];
        if (x === null || y === null) return (x === null) - (y === null);
        const order = column.words ? (x < y ? -1 : x > y ? 1 : 0) : number(x) - number(y);
        return state.falls ? -order : order;
      };
      state.order.sort(by);
    }
    draw();
  }

  function draw() {
    const head = $("head");
    head.replaceChildren();
    for (const column of visible()) {
      const sorted = state.sort === column.name;
      const th = make("th", null, { scope: "col", className: column.words ? "word" : "" });
      th.setAttribute("aria-sort", sorted ? (state.falls ? "descending" : "ascending") : "none");
      const button = make("button", titled(column) + (sorted ? (state.falls ? " ▼" : " ▲") : ""), { type: "button" });
      button.onclick = () => {
        [state.falls, state.sort] = [sorted && !state.falls, column.name];
        arrange();
        [...head.querySelectorAll("button")].find((b) => b.textContent.startsWith(titled(column)))?.focus();
      };
      th.append(button);
      head.append(th);
    }
    const body = $("body");
    body.replaceChildren();
    for (const row of state.order.slice(0, state.most)) {
      const tr = make("tr", null, { tabIndex: 0 });
      tr.setAttribute("aria-selected", String(row === state.chosen));
      tr.dataset.row = row;
      for (const column of visible()) {
        const td = make("td", shown(cell(column, row)));
        if (column.words) td.className = "word";
        if (td.textContent.length > 40) td.title = td.textContent;
        tr.append(td);
      }
      tr.onclick = () => choose(row);
      tr.onkeydown = (event) => {
        const next = { ArrowDown: tr.nextElementSibling, ArrowUp: tr.previousElementSibling }[event.key];
        if (event.key === "Enter" || event.key === " ") choose(row);
        else if (next) next.focus();
        else return;
        event.preventDefault();
      };
      body.append(tr);
    }
    const of = data.table.of > rows.length ? `, the most telling of ${data.table.of.toLocaleString("en")} rows` : "";
    const unknown = state.unknown.map((name) => `; no column is called ${name}, or several begin so`).join("");
    $("count").textContent = `${state.order.length.toLocaleString("en")} of ${rows.length.toLocaleString("en")} rows${of}${unknown}`;
    $("more").hidden = state.order.length <= state.most;
    const picks = $("picks");
    picks.replaceChildren();
    for (const [name, pick] of state.picks) {
      const said = pick.between ? `from ${pick.between[0]} to ${pick.between[1]}` : pick["one-of"] ? `= ${pick["one-of"].join(" or ")}` : "= one of the others";
      const button = make("button", `${name} ${said}  ×`, { type: "button", title: "take this condition away" });
      button.onclick = () => {
        state.picks = state.picks.filter((pick) => pick[0] !== name);
        arrange();
      };
      picks.append(button);
    }
  }

  function choose(row, scroll = false) {
    state.chosen = row;
    for (const tr of $("body").children) tr.setAttribute("aria-selected", String(Number(tr.dataset.row) === row));
    const box = $("chosen");
    box.replaceChildren(make("h3", "The chosen case"));
    const value = (name) => (place.has(name) ? cell(columns[place.get(name)], row) : null);
    if (replay && value("case") !== null) {
      const command = `${replay} ${value("case")}`;
      const line = make("pre", command);
      const copy = make("button", "copy", { type: "button", className: "more" });
      copy.onclick = async () => {
        await navigator.clipboard?.writeText(command).then(() => (copy.textContent = "copied"), () => (copy.textContent = "select and copy"));
      };
      const here = replay.startsWith("gotai run . ") ? ", in the folder of this page" : "";
      box.append(make("p", `The same run again, recorded at every step${here}:`), line, copy);
    }
    const recording = value("recording");
    box.append(make("p", recording === null ? "It has no recording." : `Its recording: ${recording}`));
    for (const [heading, of] of [["Its configuration: that of this page, with", columns.filter((column) => column.axis)],
      ["What was measured", columns.filter((column) => !column.axis)]]) {
      const list = make("dl", null);
      for (const column of of) {
        const text = shown(cell(column, row));
        if (text !== "") list.append(make("dt", titled(column)), make("dd", text));
      }
      if (list.childElementCount > 0) box.append(make("h4", heading), list);
    }
    box.hidden = false;
    if (scroll) box.scrollIntoView({ block: "nearest" });
  }

  // Cases that a verdict names: choosing one shows it.
  function linked() {
    const cases = place.has("case") ? columns[place.get("case")] : null;
    const known = new Map(cases ? rows.map((_, row) => [cell(cases, row), row]) : []);
    for (const code of document.querySelectorAll("code.case")) {
      const row = known.get(code.dataset.case.slice(0, 12));
      if (row === undefined) continue;
      const button = make("button", code.textContent, { type: "button", className: "case", title: "show this case" });
      button.onclick = () => choose(row, true);
      code.replaceWith(button);
    }
  }

  // What can be typed, with columns that are there.
  function hinted() {
    const outcomes = columns[place.get("outcome")]?.words ?? [];
    const axis = columns.find((column) => column.axis && !column.words);
    const middle = axis && axis.values.filter((x) => x !== null).map(number).sort((a, b) => a - b);
    const hints = [
      outcomes.length > 1 ? `outcome=${outcomes.find((word) => word !== "finished") ?? outcomes[0]}` : null,
      axis && middle.length > 0 ? `${axis.name}>=${middle[Math.floor(middle.length / 2)]}` : null,
    ].filter((hint) => hint !== null);
    $("filter").placeholder = hints.length > 0 ? hints.join(" ") : "a word, or column=value";
  }

  if (columns.length > 0) {
    hinted();
    linked();
    $("filter").oninput = () => { state.most = 100; arrange(); };
    $("more").onclick = () => { state.most += 500; draw(); };
    $("all").onclick = () => {
      state.all = !state.all;
      $("all").setAttribute("aria-pressed", String(state.all));
      draw();
    };
    arrange();
  }

  // ---- plots
  const script = document.createElement("script");
  script.textContent = await inflated("plotly");
  document.head.append(script);
  const colour = (name) => getComputedStyle(root).getPropertyValue(name).trim();
  const at = new Map(rows.map((row, i) => [row, i]));

  // Letters of a label, where an entity is one of them.
  const split = (text) => text.match(/&[#\w]+;|[^]/gu) ?? [];
  const cut = (text, most) => (split(text).length > most ? `${split(text).slice(0, most - 1).join("")}…` : text);
  const longest = (texts) => Math.max(0, ...texts.map((text) => split(text).length));

  // A name in lines, each of at most so many letters.
  function broken(text, most) {
    if (split(text).length <= most) return text;
    const lines = [""];
    for (const word of text.split(" ")) {
      if (lines.at(-1) !== "" && split(`${lines.at(-1)} ${word}`).length > most) lines.push("");
      lines[lines.length - 1] += `${lines.at(-1) === "" ? "" : " "}${word}`;
    }
    return lines.slice(0, 2).map((line) => cut(line, most)).join("<br>");
  }

  // Names along x that have no room lie on their side, and every so many of numbers is left out.
  function fitted(axis, room, letter, most) {
    const texts = axis.ticktext.map((text) => cut(text, most));
    const wide = letter * longest(texts) + 8;
    const areNumbers = texts.every((text) => /^[-−+\d.e…∞]+$/.test(text));
    if (wide <= room) return { ...axis, ticktext: texts, tickangle: 0 };
    const across = Math.ceil(wide / room);
    const [every, tickangle] = areNumbers && across <= 6 ? [across, 0] : [Math.max(1, Math.ceil((2 * letter + 3) / room)), -90];
    const keep = (_, i) => i % every === 0;
    return { ...axis, tickvals: axis.tickvals.filter(keep), ticktext: texts.filter(keep), tickangle };
  }

  function themed(figure, div) {
    const [paper, ink, grid, muted] = ["--paper", "--ink", "--grid", "--muted"].map(colour);
    const axis = (given) => ({ zeroline: false, ...given, gridcolor: grid, linecolor: muted, tickcolor: muted, zerolinecolor: grid });
    const narrow = div.clientWidth < 560;
    const size = narrow ? 11 : 13;
    const letter = 0.6 * size;
    const isNamed = (given) => given.showgrid === false;
    const heat = figure.data.find((trace) => trace.type === "heatmap");
    let { xaxis, yaxis, annotations } = figure.layout;
    let height = Number(div.dataset.height);
    const most = narrow ? 12 : 24;
    if (isNamed(yaxis)) yaxis = { ...yaxis, ticktext: yaxis.ticktext.map((text) => broken(text, most)) };
    const room = Math.max(40, div.clientWidth - 60 - letter * longest(yaxis.ticktext.flatMap((text) => text.split("<br>"))) - (heat && !narrow ? 90 : 12));
    if (isNamed(xaxis)) {
      const columns = xaxis.tickvals.length;
      xaxis = fitted(xaxis, room / columns, letter, most);
      if (xaxis.tickangle !== 0) height += letter * longest(xaxis.ticktext);
      if (heat) {
        const fits = Math.min(size, room / columns / (0.62 * longest(annotations.map(({ text }) => text))));
        annotations = fits < 7 ? [] : annotations.map((given) => ({ ...given, font: { ...given.font, size: fits } }));
      }
    }
    // Along the side where there is room for its title.
    const bar = narrow || letter * longest([heat?.colorbar.title.text ?? ""]) > Number(div.dataset.height) - 150
      ? { orientation: "h", x: 0.5, y: 1.02, yanchor: "bottom", len: 1, title: { ...heat?.colorbar.title, side: "top" } } : {};
    if (heat && bar.orientation) height += 70;
    // A legend of a line a series takes its room below the plot, and none of the plot's.
    const entries = figure.data.filter((trace) => trace.type === "scatter" && trace.showlegend !== false);
    if (narrow && entries.length > 1) height += entries.reduce((sum, trace) => sum + 19 * trace.name.split("<br>").length, 0);
    const layout = {
      ...figure.layout, annotations, paper_bgcolor: paper, plot_bgcolor: paper,
      font: { color: ink, size, family: "system-ui, DejaVu Sans, Verdana, sans-serif" },
      xaxis: axis(xaxis), yaxis: axis(yaxis), hovermode: "closest", dragmode: narrow ? false : "zoom",
      margin: { l: 50, r: 12, t: 16, b: 50 }, height,
      legend: { orientation: "h", y: narrow ? -0.27 : -0.22, yanchor: "top" }, hoverlabel: { align: "left" },
    };
    const data = figure.data.map((trace) => (trace === heat ? { ...trace, colorbar: { ...trace.colorbar, ...bar } } : trace));
    return [data, layout];
  }

  function chosen(event) {
    const point = event.points.find((point) => point.data.customdata);
    if (!point) return;
    const i = point.pointNumber;
    const about = Array.isArray(i) ? point.data.customdata[i[0]][i[1]] : point.data.customdata[i];
    if (about?.pick) {
      state.picks = about.pick;
      $("filter").value = "";
      state.most = 100;
      arrange();
    }
    const row = about && at.get(about.row);
    if (row !== undefined) choose(row, true);
  }

  const drawn = [];
  const again = () => drawn.forEach(([div, figure]) => Plotly.react(div, ...themed(figure, div)));
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", again);
  let wide = window.innerWidth;
  window.addEventListener("resize", () => {
    // A phone that is turned; not its address bar that comes and goes.
    if (window.innerWidth !== wide) setTimeout(again);
    wide = window.innerWidth;
  });
  for (const figure of data.figures) {
    const div = document.querySelector(`[data-figure="${figure.name}"]`);
    div.hidden = false;
    div.closest("figure").classList.add("drawn");
    await Plotly.newPlot(div, ...themed(figure, div), { responsive: true, displaylogo: false, displayModeBar: false });
    div.on("plotly_click", chosen);
    drawn.push([div, figure]);
    // The first one is there, and the table: the others are drawn between what the user does.
    root.dataset.ready ??= Math.round(performance.now());
    await new Promise((resolve) => setTimeout(resolve));
  }
  root.dataset.ready ??= Math.round(performance.now());
  root.dataset.drawn = Math.round(performance.now());
})().catch((error) => {
  document.documentElement.dataset.failed = String(error);
  console.error(error);
});
