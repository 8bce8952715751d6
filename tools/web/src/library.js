// The parts of Apache ECharts that the page uses; the bundler leaves out all others.
import { BarChart, CustomChart, LineChart, ScatterChart } from "echarts/charts";
import { DataZoomComponent, GridComponent, PolarComponent, TooltipComponent } from "echarts/components";
import * as echarts from "echarts/core";
import { CanvasRenderer, SVGRenderer } from "echarts/renderers";

echarts.use([
  BarChart, CustomChart, LineChart, ScatterChart,
  DataZoomComponent, GridComponent, PolarComponent, TooltipComponent,
  CanvasRenderer, SVGRenderer,
]);

export { echarts };
