'use strict';
document.documentElement.classList.add('js');
for (const slider of document.querySelectorAll('.slide input')) {
  const pair = slider.closest('.shot').querySelector('.pair');
  const move = () => {
    pair.style.setProperty('--at', slider.value + '%');
    slider.setAttribute('aria-valuetext', slider.value + ' % before, ' + (100 - slider.value) + ' % after');
  };
  slider.addEventListener('input', move);
  move();
}
let closed = [];
addEventListener('beforeprint', () => {
  closed = [...document.querySelectorAll('details:not([open])')];
  for (const fold of closed) fold.open = true;
});
addEventListener('afterprint', () => { for (const fold of closed) fold.open = false; });
