"use strict";
// Runs can be hidden, lines can be read. The page is whole without either.
(function () {
  var chips = document.querySelectorAll(".chip[data-chip]");
  function show(run, visible) {
    document.querySelectorAll('svg [data-run="' + run + '"]').forEach(function (shape) {
      shape.classList.toggle("hidden", !visible);
    });
  }
  var names = {}, colours = {};
  chips.forEach(function (chip) {
    var run = chip.dataset.chip;
    names[run] = chip.textContent;
    colours[run] = chip.querySelector("i").style.background;
    if (chips.length < 2) return;
    var button = document.createElement("button");
    button.type = "button";
    button.className = chip.className;
    button.title = chip.title + " (click to hide or show)";
    button.setAttribute("aria-pressed", "true");
    while (chip.firstChild) button.appendChild(chip.firstChild);
    button.addEventListener("click", function () {
      var visible = button.getAttribute("aria-pressed") !== "true";
      button.setAttribute("aria-pressed", String(visible));
      show(run, visible);
    });
    chip.replaceWith(button);
  });

  // Points of a line, read from its path once.
  var known = new WeakMap();
  function points(path) {
    if (!known.has(path)) {
      var numbers = (path.getAttribute("d").match(/-?[\d.]+/g) || []).map(Number);
      var list = [];
      for (var i = 0; i + 1 < numbers.length; i += 2) list.push([numbers[i], numbers[i + 1]]);
      known.set(path, list);
    }
    return known.get(path);
  }
  function nearest(list, x) {
    var low = 0, high = list.length - 1;
    while (high - low > 1) {
      var middle = (low + high) >> 1;
      if (list[middle][0] < x) low = middle; else high = middle;
    }
    return Math.abs(list[low][0] - x) < Math.abs(list[high][0] - x) ? list[low] : list[high];
  }
  function rounded(value) {
    return value.toPrecision(Math.abs(value) >= 1000 ? 4 : 3).replace("-", "−");
  }

  document.querySelectorAll("figure").forEach(function (figure) {
    var panels = figure.querySelectorAll("[data-panel]");
    var svg = figure.querySelector("svg");
    if (!panels.length) return;
    var tip = document.createElement("div");
    tip.className = "tip hidden";
    figure.appendChild(tip);
    var cursor = document.createElementNS("http://www.w3.org/2000/svg", "line");
    cursor.setAttribute("class", "cursor hidden");
    svg.appendChild(cursor);
    function clear() {
      tip.classList.add("hidden");
      cursor.classList.add("hidden");
    }
    svg.addEventListener("mouseleave", clear);
    svg.addEventListener("mousemove", function (event) {
      var matrix = svg.getScreenCTM();
      if (!matrix) return;
      var at = new DOMPoint(event.clientX, event.clientY).matrixTransform(matrix.inverse());
      var panel = null, frame = null;
      panels.forEach(function (candidate) {
        var f = candidate.dataset.panel.split(" ").map(Number);
        if (at.x >= f[0] && at.x <= f[0] + f[2] && at.y >= f[1] && at.y <= f[1] + f[3]) {
          panel = candidate;
          frame = f;
        }
      });
      if (!panel) return clear();
      var log = panel.dataset.log === "1";
      var rows = [], x = at.x;
      panel.querySelectorAll("path.line").forEach(function (path) {
        var group = path.closest("[data-run]");
        if (!group || group.classList.contains("hidden")) return;
        var list = points(path);
        if (!list.length) return;
        var point = nearest(list, at.x);
        var share = 1 - (point[1] - frame[1]) / frame[3];
        var value = log ? frame[6] * Math.pow(frame[7] / frame[6], share)
                        : frame[6] + share * (frame[7] - frame[6]);
        x = point[0];
        rows.push([group.dataset.run, value]);
      });
      if (!rows.length) return clear();
      tip.textContent = "";
      var head = document.createElement("div");
      var where = frame[4] + (x - frame[0]) / frame[2] * (frame[5] - frame[4]);
      head.textContent = rounded(where) + " " + panel.dataset.x;
      tip.appendChild(head);
      rows.forEach(function (row) {
        var line = document.createElement("div");
        var dot = document.createElement("i");
        dot.style.background = colours[row[0]];
        var value = document.createElement("b");
        value.textContent = rounded(row[1]) + " " + panel.dataset.y;
        line.append(dot, names[row[0]] || "", value);
        tip.appendChild(line);
      });
      cursor.setAttribute("x1", x);
      cursor.setAttribute("x2", x);
      cursor.setAttribute("y1", frame[1]);
      cursor.setAttribute("y2", frame[1] + frame[3]);
      cursor.classList.remove("hidden");
      tip.classList.remove("hidden");
      var box = figure.getBoundingClientRect();
      var left = event.clientX - box.left + 16;
      if (left + tip.offsetWidth > box.width - 8) left -= tip.offsetWidth + 32;
      tip.style.left = Math.max(4, left) + "px";
      tip.style.top = (event.clientY - box.top + 14) + "px";
    });
  });
})();
