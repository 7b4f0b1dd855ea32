"use strict";
// Runs can be hidden, charts and fields enlarged and read. The page is whole without any of it.
(function () {
  const NAMESPACE = "http://www.w3.org/2000/svg", MOST = 40, names = {}, colours = {};

  // ---- runs -------------------------------------------------------------------------------------
  const chips = document.querySelectorAll(".chip[data-chip]");
  chips.forEach((chip) => {
    const run = chip.dataset.chip;
    names[run] = chip.textContent;
    colours[run] = chip.querySelector("i").style.background;
    if (chips.length < 2) return;
    const button = Object.assign(document.createElement("button"), {
      type: "button", className: chip.className, title: chip.title + " (click to hide or show)",
    });
    button.setAttribute("aria-pressed", "true");
    while (chip.firstChild) button.appendChild(chip.firstChild);
    button.addEventListener("click", () => {
      const visible = button.getAttribute("aria-pressed") !== "true";
      button.setAttribute("aria-pressed", String(visible));
      const shapes = document.querySelectorAll('svg [data-run="' + run + '"]');
      shapes.forEach((shape) => shape.classList.toggle("hidden", !visible));
    });
    chip.replaceWith(button);
  });

  // ---- what is folded away opens for its link and for the printer --------------------------------
  function unfold() {
    const target = location.hash && document.getElementById(decodeURIComponent(location.hash.slice(1)));
    if (target && target.tagName === "DETAILS") target.open = true;
  }
  addEventListener("hashchange", unfold);
  unfold();
  let folded = [];
  addEventListener("beforeprint", () => {
    folded = Array.from(document.querySelectorAll("details:not([open])"));
    folded.forEach((part) => { part.open = true; });
  });
  addEventListener("afterprint", () => folded.forEach((part) => { part.open = false; }));

  // ---- numbers ----------------------------------------------------------------------------------
  function rounded(value) {
    const size = Math.abs(value);
    return value.toFixed(size >= 100 ? 0 : size >= 10 ? 1 : size >= 1 ? 2 : 3).replace("-", "−");
  }
  function ticksOf(low, high, count) {
    const values = d3.ticks(Math.min(low, high), Math.max(low, high), Math.max(2, count));
    const step = values.length > 1 ? values[1] - values[0] : 1;
    const decimals = Math.max(0, -Math.floor(Math.log10(step) + 1e-9));
    return values.map((value) => [value, value.toFixed(Math.min(decimals, 8)).replace("-", "−")]);
  }
  // As on the sheet: powers of ten, and two and five times them where there are few.
  function powersOf(low, high) {
    const values = [], multiples = high > 1e3 * low ? [1] : [1, 2, 5];
    for (let power = Math.floor(Math.log10(low)); power <= Math.log10(high); power += 1) {
      multiples.forEach((multiple) => {
        const value = multiple * Math.pow(10, power);
        const words = power < -3 ? multiple + "e−" + -power : value.toFixed(Math.max(0, -power));
        if (value >= low && value <= high) values.push([value, words]);
      });
    }
    return values.length > 1 ? values : ticksOf(low, high, 4);
  }

  // ---- one pair of axes -------------------------------------------------------------------------
  function Panel(group) {
    const data = group.dataset;
    const [left, top, width, height, x0, x1, y0, y1] = data.panel.split(" ").map(Number);
    const key = data.panel.split(" ").slice(0, 4).join(" ");
    const svg = group.ownerSVGElement;
    const both = data.zoom === "xy";
    const [logX, logY] = data.log.split(" ").map((flag) => flag === "1");
    const share = (value, low, high, log) =>
      log ? Math.log(value / low) / Math.log(high / low) : (value - low) / (high - low);
    const valueAt = (part, low, high, log) => log ? low * Math.pow(high / low, part) : low + part * (high - low);
    const panel = {
      group, svg, left, top, width, height, both, data,
      zoomed: [group, ...svg.querySelectorAll('[data-behind="' + key + '"]')].map((one) => one.querySelector(".zoom")),
      transform: d3.zoomIdentity,
      // Panels that show the same are enlarged together.
      kin: data.zoom + data.panel.split(" ").slice(4, both ? 8 : 6).join(" ") + [width, both && height],
      xOf: (at) => valueAt((at - left) / width, x0, x1, logX),
      yOf: (at) => valueAt(1 - (at - top) / height, y0, y1, logY),
      // From the sheet to the sheet as it was drawn, and back.
      undo([x, y]) {
        const t = panel.transform;
        const u = [(x - left - t.x) / t.k + left, (y - top - t.y) / t.k + top];
        return both ? u : [u[0], y];
      },
      redo([x, y]) {
        const t = panel.transform;
        const v = [(x - left) * t.k + t.x + left, (y - top) * t.k + t.y + top];
        return both ? v : [v[0], y];
      },
    };
    panel.ticks = Array.from(svg.querySelectorAll('[data-frame="' + key + '"]'), (element) => ({
      element,
      axis: element.dataset.ticks,
      drawn: Array.from(element.childNodes),
    }));
    // Marks and words keep their size.
    const sized = panel.zoomed.flatMap((one) => Array.from(one.querySelectorAll('text, circle:not([fill="none"])')));
    panel.fixed = sized.map((shape) => {
      const isText = shape.tagName === "text";
      const x = Number(shape.getAttribute(isText ? "x" : "cx"));
      const y = Number(shape.getAttribute(isText ? "y" : "cy"));
      return { shape, x, y, turn: shape.getAttribute("transform") || "" };
    });
    panel.apply = function (transform) {
      const k = transform.k, down = both ? k : 1;
      panel.transform = transform;
      const x = left + transform.x - k * left;
      const y = both ? top + transform.y - k * top : 0;
      panel.zoomed.forEach((one) => {
        one.setAttribute("transform", "matrix(" + [k, 0, 0, down, x, y] + ")");
        one.classList.toggle("zoomed", k > 1);
      });
      panel.fixed.forEach(({ shape, x, y, turn }) => {
        const back = "translate(" + x + " " + y + ") scale(" + 1 / k + " " + 1 / down + ") translate(" + -x + " " + -y + ") ";
        shape.setAttribute("transform", k > 1 ? back + turn : turn);
      });
      panel.ticks.forEach((ticks) => retick(ticks, k));
      panel.catcher.classList.toggle("wide", k > 1);
      panel.catcher.style.touchAction = k > 1 ? "none" : "pan-x pan-y";
    };
    function retick({ element, axis, drawn }, k) {
      if (k === 1 || (axis === "y" && !both)) return element.replaceChildren(...drawn);
      const path = drawn.find((shape) => shape.tagName === "path");
      const label = drawn.find((shape) => shape.tagName === "text");
      if (!path) return;
      const start = path.getAttribute("d").match(/-?[\d.]+/g).map(Number);
      const from = axis === "x" ? start[0] : start[1];
      const ends = axis === "x" ? [left, left + width] : [top + height, top];
      const of = axis === "x" ? panel.xOf : panel.yOf;
      const [low, high] = ends.map((end) => {
        const point = panel.undo(axis === "x" ? [end, top] : [left, end]);
        return of(axis === "x" ? point[0] : point[1]);
      });
      const count = drawn.filter((shape) => shape.tagName === "path").length;
      const values = (axis === "x" ? logX : logY) ? powersOf(low, high) : ticksOf(low, high, count);
      const shapes = [];
      values.forEach(([value, words]) => {
        const place = axis === "x"
          ? panel.redo([left + share(value, x0, x1, logX) * width, top])[0]
          : panel.redo([left, top + (1 - share(value, y0, y1, logY)) * height])[1];
        const move = "translate(" + (axis === "x" ? [place - from, 0] : [0, place - from]) + ")";
        const mark = path.cloneNode(false);
        mark.setAttribute("transform", move);
        shapes.push(mark);
        if (!label) return;
        const text = label.cloneNode(false);
        text.setAttribute("transform", move);
        text.textContent = words;
        shapes.push(text);
      });
      element.replaceChildren(...shapes);
    }
    return panel;
  }

  // ---- values of a line and of a field ----------------------------------------------------------
  const known = new WeakMap();
  function points(path) {
    if (!known.has(path)) {
      const numbers = (path.getAttribute("d").match(/-?[\d.]+/g) || []).map(Number);
      const list = [];
      for (let i = 0; i + 1 < numbers.length; i += 2) list.push([numbers[i], numbers[i + 1]]);
      known.set(path, list);
    }
    return known.get(path);
  }
  function nearest(list, at, axis) {
    return list.reduce((best, point) =>
      Math.abs(point[axis] - at) < Math.abs(best[axis] - at) ? point : best, list[0]);
  }
  function ofLines(panel, [x, y]) {
    const axis = panel.data.along === "y" ? 1 : 0, at = axis ? y : x;
    const found = new Map();
    let place = at;
    panel.group.querySelectorAll("path.line").forEach((path) => {
      const run = path.closest("[data-run]"), line = path.closest("[data-line]");
      if (run && run.classList.contains("hidden")) return;
      const name = line ? line.dataset.line : run ? names[run.dataset.run] : "";
      const list = points(path);
      if (!list.length) return;
      const point = nearest(list, at, axis);
      // Of a line in pieces, the piece that is there.
      const distance = Math.abs(point[axis] - at);
      if (found.has(name) && found.get(name).distance <= distance) return;
      const value = axis ? panel.xOf(point[0]) : panel.yOf(point[1]);
      const unit = axis ? panel.data.x : panel.data.y;
      place = point[axis];
      found.set(name, { distance, row: [getComputedStyle(path).stroke, name, rounded(value) + " " + unit] });
    });
    if (!found.size) return null;
    const head = axis ? rounded(panel.yOf(place)) + " " + panel.data.y
                      : rounded(panel.xOf(place)) + " " + panel.data.x;
    return { head, rows: Array.from(found.values(), (one) => one.row), place, axis };
  }
  // Pixels of an image of the drawing: they lie in the page, so they can be read.
  const images = new WeakMap();
  function pixels(image) {
    if (!images.has(image)) {
      images.set(image, null);
      const copy = new Image();
      copy.onload = () => {
        const canvas = document.createElement("canvas");
        canvas.width = copy.naturalWidth;
        canvas.height = copy.naturalHeight;
        const context = canvas.getContext("2d", { willReadFrequently: true });
        context.drawImage(copy, 0, 0);
        images.set(image, context.getImageData(0, 0, canvas.width, canvas.height));
      };
      copy.src = image.getAttribute("href");
    }
    return images.get(image);
  }
  function palette(svg) {
    const image = svg.querySelector("[data-bar] image"), data = image && pixels(image);
    if (!data) return null;
    if (!data.shares) {
      data.shares = new Map();
      for (let row = 0; row < data.height; row += 1) {
        data.shares.set(data.data.slice(4 * row, 4 * row + 3).join(), 1 - row / (data.height - 1));
      }
    }
    return data.shares;
  }
  function ofField(panel, [x, y]) {
    const image = panel.group.querySelector("image"), data = image && pixels(image);
    const shares = palette(panel.svg);
    if (!data || !shares) return null;
    const column = Math.floor((x - panel.left) / panel.width * data.width);
    const row = Math.floor((y - panel.top) / panel.height * data.height);
    const at = 4 * (Math.min(row, data.height - 1) * data.width + Math.min(column, data.width - 1));
    const share = shares.get(data.data.slice(at, at + 3).join());
    if (share === undefined) return null;
    const [low, high] = panel.data.field.split(" ").map(Number);
    const bound = share === 0 ? "≤ " : share === 1 ? "≥ " : "";
    return bound + (low + share * (high - low)).toFixed(2).replace("-", "−") + " " + panel.data.unit;
  }

  // ---- one drawing ------------------------------------------------------------------------------
  document.querySelectorAll("figure").forEach((figure) => {
    const svg = figure.querySelector("svg");
    const groups = Array.from(figure.querySelectorAll("[data-panel]"));
    const tip = document.createElement("div");
    tip.className = "tip hidden";
    figure.appendChild(tip);
    function tell(event, head, rows) {
      tip.textContent = "";
      const first = document.createElement("div");
      first.textContent = head;
      tip.appendChild(first);
      rows.forEach(([colour, name, value]) => {
        const line = document.createElement("div");
        const dot = document.createElement("i");
        dot.style.background = colour;
        const number = document.createElement("b");
        number.textContent = value;
        line.append(dot, name || "", number);
        tip.appendChild(line);
      });
      tip.classList.remove("hidden");
      const box = figure.getBoundingClientRect();
      let left = event.clientX - box.left + 16;
      if (left + tip.offsetWidth > box.width - 8) left -= tip.offsetWidth + 32;
      tip.style.left = Math.max(4, left) + "px";
      tip.style.top = (event.clientY - box.top + 14) + "px";
    }
    const cursor = document.createElementNS(NAMESPACE, "line");
    cursor.setAttribute("class", "cursor hidden");
    function clear() {
      tip.classList.add("hidden");
      cursor.classList.add("hidden");
    }
    // Marks tell their words, under the panels' catchers as beside them.
    const marks = Array.from(svg.querySelectorAll("[data-mark]"));
    function markAt(event) {
      return marks.find((mark) => {
        if (mark.closest(".hidden")) return false;
        const box = mark.getBoundingClientRect();
        return event.clientX >= box.left - 4 && event.clientX <= box.right + 4
          && event.clientY >= box.top - 4 && event.clientY <= box.bottom + 4;
      });
    }
    svg.addEventListener("pointerleave", clear);
    // Pixels are there by the time the pointer reaches a field.
    figure.addEventListener("pointerenter", () => {
      if (svg.querySelector("[data-bar]")) svg.querySelectorAll("image").forEach(pixels);
    }, { once: true });
    svg.addEventListener("pointermove", (event) => {
      const mark = markAt(event);
      if (mark) {
        cursor.classList.add("hidden");
        tell(event, mark.dataset.mark, []);
      } else if (!event.target.closest(".catch")) {
        clear();
      }
    });
    if (!groups.length) return;
    const panels = groups.map(Panel);
    panels.forEach((panel) => {
      const catcher = document.createElementNS(NAMESPACE, "rect");
      ["x", "y", "width", "height"].forEach((name, index) => {
        catcher.setAttribute(name, [panel.left, panel.top, panel.width, panel.height][index]);
      });
      catcher.setAttribute("class", "catch");
      svg.appendChild(catcher);
      panel.catcher = catcher;
      catcher.addEventListener("pointermove", (event) => {
        if (markAt(event)) return;
        const at = panel.undo(d3.pointer(event, svg));
        if (panel.data.field) {
          const kin = panels.filter((other) => other.data.field && other.kin === panel.kin);
          const rows = kin.map((other) => {
            const moved = [at[0] - panel.left + other.left, at[1] - panel.top + other.top];
            return [colours[other.data.colour] || "var(--run-" + other.data.colour + ")",
              other.data.name, ofField(other, moved) || "…"];
          });
          const place = rounded(panel.xOf(at[0])) + " " + panel.data.x + ", "
            + rounded(panel.yOf(at[1])) + " " + panel.data.y;
          return tell(event, place, rows);
        }
        const found = ofLines(panel, at);
        if (!found) return clear();
        tell(event, found.head, found.rows);
        const [x, y] = panel.redo([found.place, found.place]);
        const ends = found.axis ? [panel.left, y, panel.left + panel.width, y]
                                : [x, panel.top, x, panel.top + panel.height];
        ["x1", "y1", "x2", "y2"].forEach((name, index) => cursor.setAttribute(name, ends[index]));
        cursor.classList.remove("hidden");
      });
    });
    svg.appendChild(cursor);
    enlarge(figure, panels, clear);
  });

  // ---- zoom: Ctrl and wheel, two fingers, double click, buttons; what is enlarged is dragged -------
  function enlarge(figure, panels, clear) {
    const isWide = () => panels.some((panel) => panel.transform.k > 1);
    // What else a pointer does belongs to the page.
    function filter(event) {
      if (event.type === "wheel") return event.ctrlKey || event.metaKey;
      if (event.type === "dblclick") return true;
      if (event.touches) return event.touches.length > 1 || isWide();
      return !event.button && isWide();
    }
    let busy = false;
    panels.forEach((panel) => {
      const area = [[0, 0], [panel.width, panel.height]];
      // Transforms are about the frame's own corner.
      panel.zoom = d3.zoom().scaleExtent([1, MOST]).extent(area).translateExtent(area)
        .filter(filter)
        .on("zoom", (event) => {
          clear();
          panel.apply(event.transform);
          if (busy) return;
          busy = true;
          panels.filter((other) => other !== panel && other.kin === panel.kin).forEach((other) => {
            d3.select(other.carrier).call(other.zoom.transform, event.transform);
          });
          busy = false;
          tools();
        });
      // The catcher in a group of its own, whose corner is that of the frame.
      const carrier = document.createElementNS(NAMESPACE, "g");
      carrier.setAttribute("transform", "translate(" + panel.left + " " + panel.top + ")");
      panel.catcher.replaceWith(carrier);
      carrier.appendChild(panel.catcher);
      panel.catcher.setAttribute("x", 0);
      panel.catcher.setAttribute("y", 0);
      panel.carrier = carrier;
      panel.catcher.style.touchAction = "pan-x pan-y";
      d3.select(carrier).call(panel.zoom);
    });
    const bar = document.createElement("div");
    bar.className = "tools";
    const buttons = [["+", "Enlarge", 1.6], ["−", "Shrink", 1 / 1.6], ["1:1", "All of it", 0]].map(([sign, words, factor]) => {
      const button = document.createElement("button");
      button.type = "button";
      button.textContent = sign;
      button.title = words + (factor > 1 ? " (Ctrl and wheel, or double click; drag to move)" : "");
      button.setAttribute("aria-label", words);
      button.addEventListener("click", () => {
        busy = true;
        panels.forEach((panel) => {
          const carrier = d3.select(panel.carrier);
          if (factor) carrier.call(panel.zoom.scaleBy, factor);
          else carrier.call(panel.zoom.transform, d3.zoomIdentity);
        });
        busy = false;
        tools();
      });
      bar.appendChild(button);
      return button;
    });
    function tools() {
      buttons[1].disabled = buttons[2].disabled = !isWide();
    }
    tools();
    figure.insertBefore(bar, figure.querySelector(".drawn"));
  }
})();
