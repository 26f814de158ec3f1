// Tables are sorted by the column whose head is pressed, and reversed when it is pressed again. Folded parts are
// unfolded for printing.
"use strict";
(function () {
  function compare(a, b) {
    var x = Number(a), y = Number(b);
    if (isNaN(x) && isNaN(y)) return a < b ? -1 : a > b ? 1 : 0;
    return isNaN(x) ? 1 : isNaN(y) ? -1 : x - y;  // what is not known comes last
  }
  document.querySelectorAll("table.sortable thead button").forEach(function (button) {
    button.addEventListener("click", function () {
      var head = button.parentNode, column = head.cellIndex, rows = head.closest("table").tBodies[0];
      var down = head.getAttribute("aria-sort") === "ascending";
      head.parentNode.querySelectorAll("th").forEach(function (other) { other.setAttribute("aria-sort", "none"); });
      head.setAttribute("aria-sort", down ? "descending" : "ascending");
      var by = row => row.cells[column].dataset.by;
      Array.from(rows.rows).sort((a, b) => (down ? -1 : 1) * compare(by(a), by(b))).forEach(row => rows.append(row));
    });
  });
  document.querySelectorAll("button.copy").forEach(function (button) {
    button.addEventListener("click", function () {
      getSelection().selectAllChildren(document.getElementById(button.dataset.of));
      document.execCommand("copy");
      button.textContent = "copied";
    });
  });
  addEventListener("beforeprint", function () {
    document.querySelectorAll("details").forEach(function (part) { part.open = true; });
  });
})();
