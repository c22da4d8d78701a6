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
  const state = { order: [], picks: [], sort: null, falls: false, most: 100, all: false, chosen: null };
  const visible = () => columns.filter((column) => state.all || column.telling);

  function parsed(text) {
    const tests = [];
    for (const token of text.match(/(?:[^\s"]+|"[^"]*")+/g) ?? []) {
      const word = token.replace(/"/g, "");
      const match = word.match(/^([^=<>!]+)(!=|<=|>=|=|<|>)(.*)$/);
      const column = match && (columns[place.get(match[1])] ?? only(match[1]));
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
    return tests;
  }

  function only(ending) {
    const found = columns.filter((column) => column.name.endsWith(`.${ending}`) || column.name.startsWith(ending));
    return found.length === 1 ? found[0] : null;
  }

  function arrange() {
    const tests = parsed($("filter").value);
    for (const [name, values] of state.picks) {
      const column = columns[place.get(name)];
      if (column) tests.push((row) => values.includes(shown(cell(column, row))));
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
    $("count").textContent = `${state.order.length.toLocaleString("en")} of ${rows.length.toLocaleString("en")} rows${of}`;
    $("more").hidden = state.order.length <= state.most;
    const picks = $("picks");
    picks.replaceChildren();
    for (const [name, values] of state.picks) {
      const button = make("button", `${name} = ${values.length > 3 ? `${values[0]} … ${values.at(-1)}` : values.join(" or ")}  ×`, { type: "button" });
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
    const list = make("dl", null);
    for (const column of columns) {
      const text = shown(cell(column, row));
      if (text !== "") list.append(make("dt", titled(column)), make("dd", text));
    }
    box.append(list);
    box.hidden = false;
    if (scroll) box.scrollIntoView({ block: "nearest" });
  }

  if (columns.length > 0) {
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

  function themed(layout, div) {
    const [paper, ink, grid, muted] = ["--paper", "--ink", "--grid", "--muted"].map(colour);
    const axis = (given) => ({ zeroline: false, ...given, gridcolor: grid, linecolor: muted, tickcolor: muted, zerolinecolor: grid });
    const narrow = div.clientWidth < 560;
    return {
      ...layout, paper_bgcolor: paper, plot_bgcolor: paper, font: { color: ink, size: narrow ? 11 : 13, family: "system-ui, DejaVu Sans, Verdana, sans-serif" },
      xaxis: axis(layout.xaxis), yaxis: axis(layout.yaxis), hovermode: "closest", dragmode: narrow ? false : "zoom",
      margin: { l: 50, r: 12, t: 16, b: 50 }, height: Number(div.dataset.height),
      legend: { orientation: "h", y: -0.22, yanchor: "top" }, hoverlabel: { align: "left" },
    };
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
  const again = () => drawn.forEach(([div, figure]) => Plotly.react(div, figure.data, themed(figure.layout, div)));
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", again);
  for (const figure of data.figures) {
    const div = document.querySelector(`[data-figure="${figure.name}"]`);
    div.hidden = false;
    div.closest("figure").classList.add("drawn");
    await Plotly.newPlot(div, figure.data, themed(figure.layout, div), { responsive: true, displaylogo: false, displayModeBar: false });
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
