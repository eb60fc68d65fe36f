import { mount } from 'svelte';
import App from './App.svelte';
import '@xyflow/svelte/dist/style.css';
import './style/theme.css';
import './style/page.css';
import './style/canvas.css';
import './style/panels.css';
import './style/view.css';

const host = document.getElementById('app')!;
host.replaceChildren();
mount(App, {target: host});
