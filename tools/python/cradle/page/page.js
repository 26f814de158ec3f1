// Tables are sorted by the column whose head is pressed, and reversed when it is pressed again. Scenes can be copied.
"use strict";
(function () {
  function compare(a, b) {
    var x = Number(a), y = Number(b);
    if (isNaN(x) && isNaN(y)) return a < b ? -1 : a > b ? 1 : 0;
    return isNaN(x) ? 1 : isNaN(y) ? -1 : x - y;  // what is not known comes last
  }
  function pressed(buttons, act) {
    document.querySelectorAll(buttons).forEach(button => button.addEventListener("click", () => act(button)));
  }
  pressed("table.sortable thead button", button => {
    var head = button.parentNode, column = head.cellIndex, rows = head.closest("table").tBodies[0];
    var down = head.getAttribute("aria-sort") === "ascending";
    head.parentNode.querySelectorAll("th").forEach(other => other.setAttribute("aria-sort", "none"));
    head.setAttribute("aria-sort", down ? "descending" : "ascending");
    var by = row => row.cells[column].dataset.by;
    Array.from(rows.rows).sort((a, b) => (down ? -1 : 1) * compare(by(a), by(b))).forEach(row => rows.append(row));
  });
  pressed("button.copy", button => {
    getSelection().selectAllChildren(document.getElementById(button.dataset.of));
    document.execCommand("copy");
    button.textContent = "copied";
  });
})();
