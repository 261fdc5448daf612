// What a reader can do with the page: cursor, zoom and legend of figures, sorting and CSV of tables. It acts on what is
// drawn; without it the page says the same.
"use strict";
(() => {
  const create = (tag, text = "", properties = {}) => {
    const element = Object.assign(document.createElement(tag), properties);
    element.append(text);
    return element;
  };
  const button = (text, title, onclick) => create("button", text, { title, onclick });
  const draw = (parent, tag, attributes) => {
    const element = document.createElementNS(parent.namespaceURI, tag);
    for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
    return parent.appendChild(element);
  };
  const show = (element, on) => element.setAttribute("visibility", on ? "visible" : "hidden");

  // A scale [name, low, high, logarithmic] takes values of the data to places between two edges, and back.
  const warp = (scale) => (scale[3] ? Math.log : Number);
  const place = (scale, [from, to], value) => {
    const [low, high, at] = [scale[1], scale[2], value].map(warp(scale));
    return from + ((at - low) / (high - low)) * (to - from);
  };
  const value = (scale, [from, to], at) => {
    const [low, high] = scale.slice(1, 3).map(warp(scale));
    const warped = low + ((at - from) / (to - from)) * (high - low);
    return scale[3] ? Math.exp(warped) : warped;
  };
  const shown = (number, [, low, high, log]) =>
    (log ? number.toPrecision(3) : number.toFixed(Math.max(0, 3 - Math.ceil(Math.log10(high - low))))).replace("-", "−");

  // Curves and areas are paths of straight lines: "M1 2l3 4z" as [[1, 2, "M"], [4, 6, "L"], []].
  const parsed = (path) => {
    let [x, y] = [0, 0];
    return [...path.matchAll(/([MLlz])\s*(?:(-?[\d.]+)\s*(-?[\d.]+))?/g)].map(([, command, right, down]) => {
      if (command === "z") return [];
      [x, y] = command === "l" ? [x + Number(right), y + Number(down)] : [Number(right), Number(down)];
      return [x, y, command.toUpperCase()];
    });
  };

  const axes = new Map(); // panels over the same range of the same quantity share cursor and zoom, in all figures

  class Panel {
    constructor(record, root, figure) {
      const [left, top, right, bottom] = record.box;
      Object.assign(this, record, { root, figure, across: [left, right], up: [bottom, top] });
      const key = JSON.stringify(this.x);
      if (!axes.has(key)) axes.set(key, { view: this.x, whole: this.x, cursor: null, panels: [] });
      this.axis = axes.get(key);
      this.axis.panels.push(this);
    }
    get shapes() { // parsed when they are first needed
      return this.known ??= [...this.root.querySelectorAll("path[clip-path]")]
        .filter((path) => /^[\sMLlz\d.-]*$/.test(path.getAttribute("d")))
        .map((path) => ({
          path, points: parsed(path.getAttribute("d")), line: path.closest("[data-curve]")?.dataset.curve,
        }));
    }
    read(line, x) {
      const at = place(this.x, this.across, x);
      for (const { points } of this.shapes.filter((shape) => shape.line === String(line))) {
        const after = points.findIndex(([right], index) => index && right >= at);
        if (after < 1 || points[after - 1][0] > at) continue;
        const [[x0, y0], [x1, y1]] = points.slice(after - 1);
        return shown(value(this.y, this.up, x1 > x0 ? y0 + ((at - x0) / (x1 - x0)) * (y1 - y0) : y1), this.y);
      }
      return "";
    }
    zoom() {
      const { view, whole } = this.axis, [bottom] = this.up;
      const move = (at) => place(view, this.across, value(this.x, this.across, at)).toFixed(2);
      const inside = (at) => view === whole || (at >= this.across[0] && at < this.across[1]);
      for (const { path, points } of this.shapes) {
        path.setAttribute("d", points.map(([x, y, command]) => (command ? `${command}${move(x)} ${y}` : "z")).join(""));
      }
      for (const mark of this.root.querySelectorAll("[clip-path] use")) {
        mark.setAttribute("x", move(mark.dataset.x ??= mark.getAttribute("x")));
      }
      for (const note of this.root.querySelectorAll("[data-note]")) {
        const { x } = note.getBBox();
        note.setAttribute("transform", `translate(${move(x) - x} 0)`);
        show(note, inside(move(x)));
      }
      const old = [...this.root.querySelectorAll("[data-xtick]")];
      for (const tick of old) show(tick, view === whole);
      this.ticks?.remove();
      if (view === whole) return;
      this.ticks = draw(this.root, "g", { class: "ticks" });
      const least = (view[2] - view[1]) / 8, power = 10 ** Math.floor(Math.log10(least));
      const step = power * [1, 2, 5, 10].find((each) => each * power >= least);
      for (let count = Math.ceil(view[1] / step); count * step <= view[2]; count += 1) {
        const x = place(view, this.across, count * step).toFixed(2);
        draw(this.ticks, "path", { d: `M${x} ${bottom}v3` });
        if (!old.some((tick) => tick.querySelector("text"))) continue;
        draw(this.ticks, "text", { x, y: bottom + 12 }).textContent = shown(count * step, ["", 0, 500 * step]);
      }
    }
    point() {
      const { cursor, view } = this.axis, [bottom, top] = this.up;
      this.cursor ??= draw(this.root, "path", { class: "cursor" });
      const inside = cursor >= view[1] && cursor <= view[2];
      this.cursor.setAttribute("d", inside ? `M${place(view, this.across, cursor)} ${bottom}V${top}` : "");
    }
  }

  const update = (axis, change) => {
    Object.assign(axis, change);
    for (const panel of axis.panels) {
      if (change.view) panel.zoom();
      if (axis.cursor !== null) panel.point();
    }
    if ("cursor" in change) for (const figure of new Set(axis.panels.map((panel) => panel.figure))) figure.tell(axis);
  };
  const look = (axis, low, high) => {
    const [name, least, most, log] = axis.whole;
    const view = [name, Math.max(low, least), Math.min(high, most), log];
    if (view[2] - view[1] < (most - least) / 1e4) return;
    update(axis, { view: view[1] === least && view[2] === most ? axis.whole : view });
  };

  class Figure {
    constructor(element, svg) {
      const { lines, panels } = JSON.parse(svg.dataset.figure);
      this.lines = lines.map((name, index) => name || `line ${index + 1}`);
      this.panels = panels.map((each, index) => new Panel(each, svg.querySelector(`[data-panel="${index}"]`), this));
      const [{ axis }] = this.panels;
      const whole = () => look(axis, axis.whole[1], axis.whole[2]);
      const zoom = (factor) => {
        const [, low, high] = axis.view, middle = axis.cursor ?? (low + high) / 2;
        look(axis, middle - (middle - low) * factor, middle + (high - middle) * factor);
      };
      const tools = create("div", "", { className: "tools" });
      tools.append(button("+", "Zoom in", () => zoom(0.5)), button("−", "Zoom out", () => zoom(2)), button("Whole", "", whole));
      tools.append(...this.lines.map((name, line) => {
        const curves = [...svg.querySelectorAll(`[data-curve="${line}"]`)];
        const toggle = button(name, "Show or hide", () => {
          const on = toggle.ariaPressed === "false";
          toggle.ariaPressed = on;
          for (const curve of curves) show(curve, on);
        });
        toggle.ariaPressed = "true";
        toggle.style.borderColor = curves[0].querySelector("path").getAttribute("stroke");
        return toggle;
      }));
      this.reading = create("table");
      tools.append(this.reading);
      element.querySelector("figcaption").before(tools);
      const box = svg.parentElement;
      box.title = "Arrow keys move the cursor, + and − zoom, Escape shows the whole";
      box.onkeydown = (event) => {
        const [, low, high] = axis.view, step = (high - low) / (event.shiftKey ? 10 : 100);
        const move = (by) => update(axis, { cursor: Math.min(high, Math.max(low, (axis.cursor ?? low) + by)) });
        const act = {
          ArrowRight: () => move(step), ArrowLeft: () => move(-step), "+": () => zoom(0.5), "-": () => zoom(2), Escape: whole,
        }[event.key];
        if (!act || event.ctrlKey || event.metaKey || event.altKey) return;
        event.preventDefault();
        act();
      };
      let start = null;
      const found = (event) => {
        const { x, y } = new DOMPoint(event.clientX, event.clientY).matrixTransform(svg.getScreenCTM().inverse());
        const panel = this.panels.find(({ box: [left, top, right, bottom] }) => x >= left && x <= right && y >= top && y <= bottom);
        return panel && { axis: panel.axis, at: value(panel.axis.view, panel.across, x) };
      };
      svg.onpointermove = (event) => {
        const here = found(event);
        if (here) update(here.axis, { cursor: here.at });
      };
      svg.onpointerdown = (event) => { start = event.pointerType === "touch" ? null : found(event); };
      svg.onpointerup = (event) => {
        const end = found(event);
        if (start && end?.axis === start.axis) look(end.axis, Math.min(start.at, end.at), Math.max(start.at, end.at));
      };
    }
    tell(axis) {
      const panels = this.panels.filter((panel) => panel.axis === axis && panel.y[0]), row = (...cells) => {
        const made = create("tr");
        made.append(...cells.map((cell, index) => create(index ? "td" : "th", cell)));
        return made;
      };
      this.reading.replaceChildren(row(`${axis.whole[0]} ${shown(axis.cursor, axis.whole.slice(0, 3))}`, ...panels.map((panel) => panel.y[0])),
        ...this.lines.map((line, index) => row(line, ...panels.map((panel) => panel.read(index, axis.cursor)))));
    }
  }
  for (const svg of document.querySelectorAll("svg[data-figure]")) new Figure(svg.closest("figure"), svg);

  const words = (cell) => {
    const copy = cell.cloneNode(true);
    for (const unspoken of copy.querySelectorAll("[aria-hidden]")) unspoken.remove();
    return copy.textContent.trim().replace(/\s+/g, " ").replace(/−(?=[\d.])/g, "-");
  };
  for (const figure of document.querySelectorAll("figure.table")) {
    const table = figure.querySelector("table"), [body] = table.tBodies, rows = [...body.rows];
    [...table.tHead.rows[0].cells].forEach((head, column) => {
      const key = (row) => words(row.cells[column]).replace(/^[^\p{L}\d-]+/u, "");
      const order = (one, other) => Number.parseFloat(one) - Number.parseFloat(other) || one.localeCompare(other);
      const sort = button("", "Sort", () => {
        const next = { ascending: "descending", descending: "none" }[head.ariaSort] ?? "ascending";
        for (const each of head.parentElement.cells) each.ariaSort = null;
        head.ariaSort = next;
        const sorted = next === "none" ? rows : rows.toSorted((one, other) => order(key(one), key(other)));
        body.append(...(next === "descending" ? sorted.reverse() : sorted));
      });
      sort.append(...head.childNodes);
      head.append(sort);
    });
    const name = `${figure.querySelector(".label").textContent}csv`; // "Table 2.csv"
    figure.querySelector("figcaption").append(" ", button("CSV", "Save this table", () => {
      const lines = [...table.rows].map((row) => [...row.cells].map((cell) => `"${words(cell).replaceAll('"', '""')}"`).join(","));
      create("a", "", { download: name, href: `data:text/csv;charset=utf-8,${encodeURIComponent(lines.join("\r\n"))}` }).click();
    }));
  }
  for (const link of document.querySelectorAll("a[href^='#File-']")) {
    link.onclick = () => document.querySelector(link.hash).click();
  }
})();
